import { Ray, Vector3 } from 'three'
import { expect, test } from 'vitest'
import { fitted } from './camera'
import { within } from './cone'
import { drawnVelocity, onPlane, Stroke } from './picking'
import { arrowScale, lengthWords, roundUp, shortNumber, steadyNumber, typicalSize } from './quantities'
import { edgesOf } from './rim'
import { roundLength } from './support'

test('a ray meets the plane in front of it, and no other', () => {
  const down = new Ray(new Vector3(1, 2, 3), new Vector3(1, 0, -1).normalize())
  expect(
    onPlane(down, 0)
      ?.toArray()
      .map((v) => Math.round(1e9 * v) / 1e9),
  ).toEqual([4, 2, 0])
  expect(onPlane(down, 1)?.x).toBeCloseTo(3, 12)
  expect(onPlane(new Ray(new Vector3(0, 0, 3), new Vector3(0, 0, 1)), 0)).toBeNull()
})

test('an arrow drawn stands for a velocity by the arrows’ own scale; a mere click for none', () => {
  const from = new Vector3(1, 1, 0)
  const velocity = drawnVelocity(from, new Vector3(1.2, 1, 0), 0.5, 0.01)
  expect(velocity.x).toBeCloseTo(0.4, 12)
  expect(drawnVelocity(from, new Vector3(1.005, 1, 0), 0.5, 0.01).length()).toBe(0)
})

test('a stroke keeps no points that lie on top of each other', () => {
  const stroke = new Stroke(0.1)
  const kept = [0, 0.05, 0.11, 0.15, 0.3].map((x) => stroke.add(new Vector3(x, 0, 0)))
  expect(kept).toEqual([true, false, true, false, true])
})

test('a force on the friction cone is not within it', () => {
  const up = new Vector3(0, 0, 1)
  expect(within(new Vector3(0.19, 0, 1), up, 0.2)).toBe(true)
  expect(within(new Vector3(0.2, 0, 1), up, 0.2)).toBe(false)
  expect(within(new Vector3(0, 0, -1), up, 0.2)).toBe(false)
})

test('a camera sees all points, and some at the edge of its picture', () => {
  const points = [-1, 1].flatMap((x) => [-1, 1].flatMap((y) => [0, 0.5].map((z) => new Vector3(x + 3, y, z))))
  for (const aspect of [0.5, 1, 2.2]) {
    const { eye, target } = fitted(points, new Vector3(0.3, -1, 0.6), 30, aspect)
    const back = eye.clone().sub(target).normalize()
    const right = new Vector3(0, 0, 1).cross(back).normalize()
    const above = back.clone().cross(right)
    const shares = points.map((point) => {
      const off = point.clone().sub(eye)
      const depth = -off.dot(back)
      const half = Math.tan(Math.PI / 12) * depth
      return Math.max(Math.abs(off.dot(right)) / (half * aspect), Math.abs(off.dot(above)) / half)
    })
    expect(Math.max(...shares)).toBeLessThanOrEqual(1)
    expect(Math.max(...shares)).toBeGreaterThan(0.85)
  }
})

test('an open mesh has its outline for an edge, across seams too; a closed one has none', () => {
  // A square of two triangles whose diagonal is a seam of doubled vertices.
  const square = Float32Array.of(0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0)
  const [line, ...others] = edgesOf(square, Uint32Array.of(0, 1, 2, 3, 4, 5))
  expect(others).toEqual([])
  expect(line!.length).toBe(15) // four corners, and the first again
  const tetrahedron = Float32Array.of(0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1)
  expect(edgesOf(tetrahedron, Uint32Array.of(0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3))).toEqual([])
})

test('scales are round and said in words', () => {
  expect([0.011, 0.02, 0.3, 1, 4.9, 700].map(roundUp)).toEqual([0.02, 0.02, 0.5, 1, 5, 1000])
  expect([0.011, 0.2, 0.3, 7].map(roundLength)).toEqual([0.01, 0.2, 0.2, 5])
  const scale = arrowScale(0.34, 'm/s', 0.25)
  expect(scale.words).toBe('0.2 m/s per 10 cm')
  expect(scale.length).toBeCloseTo(0.5, 12)
  expect(lengthWords(0.005)).toBe('5 mm')
})

test('one peak of a force does not set the scale, nor do gaps in a column', () => {
  const column = new Float32Array(300).fill(1)
  column.set([1e4, 0, 0], 30)
  column.set([Number.NaN, 0, 0], 60)
  expect(typicalSize(column)).toBeCloseTo(Math.sqrt(3), 6)
  expect(typicalSize(undefined)).toBe(0)
})

test('numbers are written as people read them', () => {
  expect([0, -0.12345, 12.3456, 1234567, -0.00001234].map(shortNumber)).toEqual([
    '0',
    '−0.123',
    '12.3',
    '1.23 × 10⁶',
    '−1.23 × 10⁻⁵',
  ])
  expect(steadyNumber(0.5, 0.7)).toBe('0.500')
  expect(steadyNumber(Number.NaN, 1)).toBe('–')
  expect(steadyNumber(-1e-9, 1)).toBe('0.00') // no minus before nothing
  expect(steadyNumber(-0.25, 1)).toBe('−0.25')
})

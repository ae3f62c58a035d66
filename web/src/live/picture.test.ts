import { expect, test } from 'vitest'
import type { Columns, Scene, SceneHeader } from '../viewer/scene'
import type { Course } from './course'
import type { LiveHeader } from './header'
import { Pictures, quaternion } from './picture'

test('a rotation is told by its quaternion, half turns too', () => {
  expect(quaternion([1, 0, 0, 0, 1, 0, 0, 0, 1])).toEqual([1, 0, 0, 0])
  expect(quaternion([-1, 0, 0, 0, -1, 0, 0, 0, 1]).map(Math.abs)).toEqual([0, 0, 0, 1])
  const [c, s] = [Math.cos(0.3), Math.sin(0.3)]
  const [w, x, y, z] = quaternion([c, -s, 0, s, c, 0, 0, 0, 1])
  expect([w, x, y, z].map((part) => part.toFixed(12))).toEqual(
    [Math.cos(0.15), 0, 0, Math.sin(0.15)].map((part) => part.toFixed(12)),
  )
})

const film = [
  ...['position', 'contact'].flatMap((name) => ['x', 'y', 'z'].map((axis) => `${name}_${axis}`)),
  ...['w', 'x', 'y', 'z'].map((part) => `orientation_${part}`),
  ...['velocity', 'angular_velocity', 'contact_force'].flatMap((name) =>
    ['x', 'y', 'z'].map((axis) => `${name}_${axis}`),
  ),
]
const course: Course = {
  time: [0, 1],
  rows: [film.map((_, i) => i), film.map((_, i) => -i)],
  phase: [0, 1],
  events: [],
  ended: null,
  parameters: [0.25],
  promised: null,
}

test('a mesh is bent through its nodes, and the file keeps its own', () => {
  // A mesh of two vertices: at the node 2 its numbers grow by 1, 2, ... 6 steps of 0.5, at 1 by none.
  const low = [1, 2, 3, 3, 3, 3]
  const columns = {
    time: Float64Array.of(0, 1),
    body_vertices: Float32Array.of(1, 1, 1, 1, 1, 1),
    live_0_0_body_vertices: new Uint8Array(12),
    live_0_1_body_vertices: Uint8Array.from([...low, 0, 0, 0, 0, 0, 0]),
  } as unknown as Columns
  const live: LiveHeader = {
    sliders: [],
    variants: [{ slider: 0, nodes: [1, 2], steps: { body_vertices: 0.5 } }],
    curves: [],
    film,
    parameters: ['support.tilt'],
  }
  const header = { body: { radius: 1 }, support: {}, gravity: [0, 0, -9], tilt: 0 } as unknown as SceneHeader
  const base: Scene = { header, columns }
  const pictures = new Pictures(base, live)
  expect([...pictures.scene(course, [2]).columns.body_vertices!]).toEqual([1.5, 2, 2.5, 3, 3.5, 4])
  expect([...pictures.scene(course, [1]).columns.body_vertices!]).toEqual([1, 1, 1, 1, 1, 1])
  expect([...pictures.scene(course, [1.5]).columns.body_vertices!]).toEqual([1.25, 1.5, 1.75, 2, 2.25, 2.5])
  expect(base.columns.body_vertices![0]).toBe(1)
  const scene = pictures.scene(course, [2])
  expect([...scene.columns.position!]).toEqual([0, 1, 2, -0, -1, -2])
  expect(scene.header.to_world[0]).toBeCloseTo(Math.cos(0.125), 15)
  expect(scene.header.body.radius).toBeCloseTo(Math.hypot(3, 3.5, 4), 6)
})

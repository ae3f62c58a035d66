import { describe, expect, it } from 'vitest'
import type { Scene } from '../../../viewer/scene'
import { apart, headingRate, markAngles, poleAt, sampleAt, turned } from './measure'

function scene(columns: Record<string, ArrayLike<number>>): Scene {
  return { header: {}, columns } as unknown as Scene
}

/** A turn by an angle about the second axis, as a cylinder makes that rolls along the first. */
const rollBy = (angle: number) => [Math.cos(angle / 2), 0, Math.sin(angle / 2), 0]

describe('reading a scene', () => {
  it('turns a vector by a quaternion', () => {
    const quarter = Math.SQRT1_2
    const [x, y, z] = turned([quarter, 0, quarter, 0], [0, 0, 1])
    expect([x, y, z].map((part) => Math.round(part * 1e9) / 1e9 + 0)).toEqual([1, 0, 0])
  })

  it('counts a mark’s turns past the full circle', () => {
    const angles = Array.from({ length: 60 }, (_, i) => i * 0.3)
    const one = scene({ time: angles, orientation: angles.flatMap((angle) => rollBy(angle)) })
    const read = markAngles(one)
    expect(read[59]).toBeCloseTo(17.7, 9)
  })

  it('finds the pole and the nearest sample', () => {
    const one = scene({ time: [0, 1, 2, 3], orientation: [0, 0, 0, Math.PI].flatMap((angle) => rollBy(angle)) })
    expect(poleAt(one, 3)[2]).toBeCloseTo(-1, 12)
    expect(sampleAt(one, 1.4)).toBe(1)
    expect(sampleAt(one, 1.6)).toBe(2)
    expect(sampleAt(one, 99)).toBe(3)
  })

  it('measures how fast the direction of motion turns', () => {
    const time = Array.from({ length: 50 }, (_, i) => i * 0.2)
    const round = scene({ time, velocity: time.flatMap((t) => [Math.cos(1.7 * t), Math.sin(1.7 * t), 0]) })
    expect(headingRate(round)).toBeCloseTo(1.7, 9)
    expect(headingRate(scene({ time, velocity: time.flatMap(() => [0, 0.1, 0]) }))).toBe(0)
    expect(headingRate(scene({ time, velocity: time.flatMap(() => [0, 0, 0]) }))).toBeNull()
  })

  it('measures how far two paths part', () => {
    const one = scene({ position: [0, 0, 0, 1, 0, 0] })
    const other = scene({ position: [0, 0, 5, 1, 0.25, 5] })
    expect(apart(one, other)).toBeCloseTo(0.25, 12)
  })
})

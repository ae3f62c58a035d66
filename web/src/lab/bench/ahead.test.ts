import { expect, it } from 'vitest'
import type { Scene } from '../../viewer/scene'
import { pathOf } from './ahead'

/** A point fixed on a table that turns by a quarter a sample. */
function ridden(samples: number): Scene {
  const time = Float64Array.from({ length: samples }, (_, i) => i)
  const angle = (i: number) => (i * Math.PI) / 2
  const contact = Float32Array.from({ length: 3 * samples }, (_, n) => {
    const i = Math.floor(n / 3)
    return [2 * Math.cos(angle(i)), 2 * Math.sin(angle(i)), 0.5][n % 3]!
  })
  const support_orientation = Float32Array.from({ length: 4 * samples }, (_, n) => {
    const half = angle(Math.floor(n / 4)) / 2
    return [Math.cos(half), 0, 0, Math.sin(half)][n % 4]!
  })
  return { header: {}, columns: { time, position: contact, contact, support_orientation } } as unknown as Scene
}

it('is one place in the frame of the support that it rides on', () => {
  for (const [x, y, z] of pathOf(ridden(9), 'corotating')) {
    expect(x).toBeCloseTo(2, 5)
    expect(y).toBeCloseTo(0, 5)
    expect(z).toBeCloseTo(0.5, 5)
  }
})

it('is the circle itself in the room, its ends kept, with few points', () => {
  const points = pathOf(ridden(10_000), 'support')
  expect(points.length).toBeLessThan(4002)
  expect(points[0]![0]).toBeCloseTo(2, 5)
  const [x, y] = points[points.length - 1]!
  expect(x).toBeCloseTo(0, 3)
  expect(y).toBeCloseTo(-2, 5)
})

import { describe, expect, it } from 'vitest'
import { drawnOf, rangesOf, stepOf } from './plot'

describe('what is drawn', () => {
  it('is the path where x and y were measured', () => {
    const drawn = drawnOf({ t: [0, 1], x: [1, null], y: [2, 3] }, {})
    expect(drawn).toMatchObject({ names: ['x, m', 'y, m'], square: true, points: [[[1, 2], null]] })
  })

  it('is each column over time where they were not', () => {
    const units = { t: 's', x: 'm', wy: 'rad/s', wz: 'rad/s' }
    const drawn = drawnOf({ t: [0, 1], x: [1, 2], wy: [3, 4], wz: [3, 4] }, units)
    expect(drawn.names).toEqual(['t, s', 'x, m; wy, wz, rad/s'])
    expect(drawn.called).toEqual(['x', 'wy', 'wz'])
    expect(drawn.points[1]).toEqual([
      [0, 3],
      [1, 4],
    ])
  })

  it('is drawn by the same rule for a step of the fit', () => {
    const way = { time: [0, 1], columns: ['x'], frames: [{ reduced: 2, share: 1, columns: [[5, 6]] }] }
    expect(stepOf(way, 0, {}).points[0]).toEqual([
      [0, 5],
      [1, 6],
    ])
  })

  it('has as many metres a pixel across as upwards where it is a path', () => {
    const points: [number, number][] = [
      [0, 0],
      [1, 0.2],
    ]
    const [across, up] = rangesOf([points], true, 400, 200) as [[number, number], [number, number]]
    expect((across[1] - across[0]) / 400).toBeCloseTo((up[1] - up[0]) / 200, 12)
    for (const [x, y] of points) {
      expect(x >= across[0] && x <= across[1] && y >= up[0] && y <= up[1]).toBe(true)
    }
  })

  it('has room where all is level, or nothing is there', () => {
    expect(rangesOf([[[0, 0]]], false, 1, 1).every(([low, high]) => high > low)).toBe(true)
    expect(rangesOf([[null]], false, 1, 1)).toEqual([
      [0, 1],
      [0, 1],
    ])
  })
})

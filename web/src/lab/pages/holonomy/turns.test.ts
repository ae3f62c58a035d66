import { describe, expect, it } from 'vitest'
import { along, backAlong, between, inWords, isHome, loop, netOf, piecesOf, type Turn, thinned } from './turns'

/** Where straight pieces lead, in quarter turns of the ball: added up here on their own. */
function endOf(turns: Turn[]): [number, number] {
  let [x, y] = [0, 0]
  for (const piece of piecesOf(turns)) {
    x += Math.cos(piece.heading as number)
    y += Math.sin(piece.heading as number)
  }
  return [Math.round(x), Math.round(y)]
}

describe('quarter turns', () => {
  it('become straight pieces of a quarter turn each', () => {
    const [east, north] = piecesOf(['E', 'N'])
    expect(east).toEqual({ kind: 'straight', heading: 0, turn: Math.PI / 2 })
    expect(north).toEqual({ kind: 'straight', heading: Math.PI / 2, turn: Math.PI / 2 })
  })

  it('lead where their headings say', () => {
    const turns: Turn[] = ['E', 'E', 'N', 'W', 'S', 'S', 'S']
    expect(endOf(turns)).toEqual([1, -2])
    expect(netOf(turns)).toEqual({ east: 1, north: -2 })
    expect(isHome(turns)).toBe(false)
    expect(isHome([...turns, 'W', 'N', 'N'])).toBe(true)
  })

  it('are taken back last first', () => {
    expect(backAlong(['E', 'N', 'N'])).toEqual(['S', 'S', 'W'])
    expect(isHome(['E', 'N', 'N', ...backAlong(['E', 'N', 'N'])])).toBe(true)
  })

  it('make a closed loop between two ways to one place', () => {
    expect(between(['E', 'N'], ['N', 'E'])).toEqual(['S', 'W', 'N', 'E'])
    expect(isHome(between(['E', 'N'], ['N', 'E']))).toBe(true)
  })

  it('are told in words', () => {
    expect(inWords(['E', 'N'])).toBe('east, then north')
  })
})

describe('loops and a hand’s way', () => {
  it('go once round, to the left or to the right', () => {
    expect(loop('circle', 0.01)).toEqual([{ kind: 'arc', radius: 0.01, angle: 2 * Math.PI, heading: 0 }])
    expect(loop('circle', 0.01, false)[0]!.angle).toBe(-2 * Math.PI)
    const square = loop('square', 0.02, false)
    expect(square.map((piece) => piece.length)).toEqual([0.02, 0.02, 0.02, 0.02])
    expect(Math.sin(square[1]!.heading as number)).toBeCloseTo(-1, 12)
  })

  it('drop points that crowd', () => {
    const points = [0, 0.1, 0.9, 1.1, 2.4].map((x) => [x, 0] as const)
    expect(thinned(points, 1).map(([x]) => x)).toEqual([0, 1.1, 2.4])
    expect(along(thinned(points, 1))).toEqual([
      { kind: 'straight', to: [1.1, 0] },
      { kind: 'straight', to: [2.4, 0] },
    ])
    expect(along([[0, 0]])).toEqual([])
  })
})

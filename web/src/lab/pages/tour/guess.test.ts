import { describe, expect, it } from 'vitest'
import { evenly, inWords, judge, meanDistance, type Point, wayOf } from './guess'

const straight: Point[] = [
  [0, 0],
  [0, 1],
]

/** Arches of a cycloid along +y, as the put-down ball draws them, but written down here by hand. */
const arches: Point[] = Array.from({ length: 400 }, (_, i) => {
  const angle = (i / 399) * 6 * Math.PI
  return [0.04 * (1 - Math.cos(angle)), 0.04 * (angle - Math.sin(angle))]
})

describe('the distance between two lines', () => {
  it('is the distance of parallel lines', () => {
    const beside: Point[] = [
      [0.2, 0],
      [0.2, 1],
    ]
    expect(meanDistance(straight, beside)).toBeCloseTo(0.2, 12)
  })

  it('is nothing for the same line drawn with other points, and backwards', () => {
    const finer = evenly(straight, 37)
    expect(meanDistance(straight, finer)).toBeCloseTo(0, 12)
    expect(meanDistance(straight, [...straight].reverse())).toBeCloseTo(0, 12)
  })

  it('counts what was left out: half the line is a quarter of its half off', () => {
    const half: Point[] = [
      [0, 0],
      [0, 0.5],
    ]
    // From the whole to the half: mean of 0 on one half and of y - 0.5 on the other, 0.125; from the half to the whole 0.
    expect(meanDistance(straight, half)).toBeCloseTo(0.0625, 3)
  })

  it('spaces points evenly', () => {
    const bent: Point[] = [
      [0, 0],
      [1, 0],
      [1, 3],
    ]
    expect(evenly(bent, 5)).toEqual([
      [0, 0],
      [1, 0],
      [1, 1],
      [1, 2],
      [1, 3],
    ])
    expect(evenly([[2, 3]], 5)).toEqual([[2, 3]])
  })
})

describe('where a line leads', () => {
  it('tells downhill, uphill and the two sides', () => {
    const to = (x: number, y: number): Point[] => [
      [0, 0],
      [x, y],
    ]
    expect(wayOf(to(1, 0.2), 1, 0.01)).toBe('downhill')
    expect(wayOf(to(-1, 0.2), 1, 0.01)).toBe('uphill')
    expect(wayOf(to(0.2, 1), 1, 0.01)).toBe('with the drift')
    expect(wayOf(to(0.2, 1), -1, 0.01)).toBe('against the drift')
    expect(wayOf(to(0.001, 0), 1, 0.01)).toBe('nowhere')
  })

  it('tells a round way from a straight one', () => {
    const circle: Point[] = Array.from({ length: 50 }, (_, i) => [Math.cos(i / 8), Math.sin(i / 8)])
    expect(wayOf(circle, 1, 0.01)).toBe('round')
    expect(wayOf(arches, 1, 0.01)).toBe('with the drift')
  })
})

describe('what is said', () => {
  it('says plainly how far off, without a mark', () => {
    const downhill: Point[] = [
      [0, 0],
      [0.5, 0],
    ]
    const off = judge(downhill, arches, 1)
    expect(off.guessed).toBe('downhill')
    expect(inWords(off)).toMatch(/^You sent the ball downhill; it went sideways.* \d+\s?cm apart/)
  })

  it('knows the path when it is drawn', () => {
    const close = arches.filter((_, i) => i % 7 === 0)
    expect(inWords(judge(close, arches, 1))).toMatch(/that is the path/)
    expect(judge(arches, arches, 1).mean).toBeCloseTo(0, 9)
  })

  it('gives the level line its due, but not the arches', () => {
    const along: Point[] = [
      [0, 0],
      [0, 0.75],
    ]
    expect(inWords(judge(along, arches, 1))).toMatch(/right way, not yet the arches/)
  })
})

import { expect, test } from 'vitest'
import { BREAK, Line, pieces } from './lines'

/** Points on the first axis at these times, or breaks. */
function at(...times: number[]): Float32Array {
  return new Float32Array(times.flatMap((t) => [t, 0, 0, t]))
}

function shown(now: number, since: number | undefined, ...times: number[]): [number, number] {
  const line = new Line()
  line.setPoints(at(...times))
  line.reach(now, 0, 1, since)
  return line.shown
}

test('only the pieces that have begun are drawn', () => {
  expect(shown(1.5, undefined, 0, 1, 2, 3)).toEqual([0, 2])
  expect(shown(0, undefined, 0, 1, 2, 3)).toEqual([0, 0])
  expect(shown(9, undefined, 0, 1, 2, 3)).toEqual([0, 3])
})

test('what is to come begins with the piece that one is on', () => {
  expect(shown(1e29, 1.5, 0, 1, 2, 3)).toEqual([1, 3])
  expect(shown(1e29, 0, 0, 1, 2, 3)).toEqual([0, 3])
  expect(shown(1e29, 3, 0, 1, 2, 3)).toEqual([2, 3])
})

test('together they are the whole line, at any time', () => {
  const times = [0, 0.5, BREAK, 0.5, 2, 4]
  for (const now of [0, 0.2, 0.5, 1, 3, 4, 5]) {
    const [first, end] = shown(now, undefined, ...times)
    const [next, last] = shown(1e29, now, ...times)
    expect(first).toBe(0)
    expect(next).toBeLessThanOrEqual(end)
    expect(last).toBe(times.length - 1)
  }
})

test('a line that does not grow with time is drawn whole', () => {
  const line = new Line()
  line.setPoints(
    pieces([
      [0, 0, 0, 1, 0, 0],
      [0, 1, 0, 1, 1, 0],
    ]),
  )
  expect(line.shown).toEqual([0, 4])
})

test('a line that shares points knows their times', () => {
  const [one, other] = [new Line(), new Line()]
  one.setPoints(at(0, 1, 2))
  other.sharePoints(one)
  other.reach(1e29, 0, 1, 1.5)
  expect(other.shown).toEqual([1, 2])
  expect(one.shown).toEqual([0, 2])
})

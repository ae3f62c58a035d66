import { expect, it } from 'vitest'
import { isFilm } from './film'
import { between, middleOf, outlineAt } from './showing'

it('finds the rows about a time, and none outside', () => {
  const times = [0, 0.1, 0.4]
  expect(between(times, 0)).toEqual([0, 1, 0])
  expect(between(times, 0.25)).toEqual([1, 2, expect.closeTo(0.5, 12)])
  expect(between(times, 0.4)).toEqual([1, 2, 1])
  expect(between(times, -0.01)).toBeNull()
  expect(between(times, 0.41)).toBeNull()
  expect(between([], 0)).toBeNull()
  expect(between([0.2], 0.2)).toEqual([0, 0, 0])
})

it('has the outline between two known ones', () => {
  const square = (x: number): [number, number][] => [
    [x, 0],
    [x + 2, 0],
    [x + 2, 2],
    [x, 2],
  ]
  const seen = { time: [1, 2], outlines: [square(0), square(10)] }
  expect(middleOf(outlineAt(seen, 1.25)!)).toEqual([3.5, 1])
  expect(outlineAt(seen, 0.5)).toBeNull()
})

it('knows a film by its type or its name', () => {
  for (const [name, type, film] of [
    ['a.MOV', '', true],
    ['a.webm', '', true],
    ['a', 'video/mp4', true],
    ['a.csv', 'text/csv', false],
    ['mov.txt', '', false],
  ] as const)
    expect(isFilm(new File([], name, { type }))).toBe(film)
})

import { expect, test } from 'vitest'
import { Pace } from './pace'

test('a quick machine keeps all its pixels', () => {
  const pace = new Pace()
  for (let i = 0; i < 1000; i++) expect(pace.frame(16 * i + (i % 100 === 0 ? 60 : 0))).toBe(false)
  expect(pace.share).toBe(1)
})

test('a slow one gives some up, step by step and not without end', () => {
  const pace = new Pace()
  for (let i = 0; i < 6; i++) pace.frame(80 * i)
  expect(pace.share).toBe(0.75)
  for (let i = 6; i < 100; i++) pace.frame(80 * i)
  expect(pace.share).toBe(0.42)
})

test('a pause is no slow frame', () => {
  const pace = new Pace()
  for (let i = 0; i < 40; i++) {
    pace.frame(1000 * i)
    pace.frame(1000 * i + 16)
    pace.rest()
  }
  expect(pace.share).toBe(1)
})

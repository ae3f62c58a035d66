import { expect, test } from 'vitest'
import { countBefore } from './ascending'

test('so many are before a value, and at it', () => {
  const times = Float64Array.of(0, 0.1, 0.4, 0.4, 0.4, 2, 7)
  for (const t of [-Infinity, -1, 0, 0.05, 0.1, 0.4, 0.5, 7, 8, Infinity]) {
    expect(countBefore(times, t)).toBe(times.filter((one) => one < t).length)
    expect(countBefore(times, t, true)).toBe(times.filter((one) => one <= t).length)
  }
  expect(countBefore([], 1)).toBe(0)
})

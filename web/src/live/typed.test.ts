import { expect, test } from 'vitest'
import { shortNumber } from '../viewer/quantities'
import { typedNumber } from './typed'

test('what the page writes itself is read again', () => {
  for (let power = -12; power <= 9; power++)
    for (const digits of [1, -1, 2.99, -4.05, 9.99]) {
      const value = digits * 10 ** power
      expect(typedNumber(shortNumber(value), 'kg')).toBeCloseTo(Number(value.toPrecision(3)), 14 - power)
      expect(typedNumber(shortNumber(value).replace('.', ','), '')).not.toBeNull()
    }
  expect(typedNumber('0', '')).toBe(0)
})

test('a number may have either decimal sign, an exponent, and the unit of its box', () => {
  expect(typedNumber(' 1,5 ', 'rpm')).toBe(1.5)
  expect(typedNumber('−1.5e-3', 'rpm')).toBe(-0.0015)
  expect(typedNumber('40 rpm', 'rpm')).toBe(40)
  expect(typedNumber('40rpm', 'rpm')).toBe(40)
  expect(typedNumber('40 U/min', 'rpm', 'U/min')).toBe(40)
  expect(typedNumber('40 rpm', 'rpm', 'U/min')).toBe(40)
  expect(typedNumber('.5', '')).toBe(0.5)
})

test('anything else is no number', () => {
  const others = [
    '',
    ' ',
    'banana',
    'rpm',
    '1 Hz',
    '1.2.3',
    '1.000,5',
    '0x1F',
    'Infinity',
    '1e999',
    'NaN',
    '--1',
    '3 4 x',
    'e5',
  ]
  for (const text of others) expect(typedNumber(text, 'rpm')).toBeNull()
})

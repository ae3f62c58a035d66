import { describe, expect, it } from 'vitest'
import german from '../../../languages/de.json'
import { speak } from '../../../languages/translate'
import { fieldAt, inPrint, labelOf, nameOf, placeOf, roundNumbers, sideOf, ticksOf } from './axes'

const axis = (values: number[], unit = 'rad/s') => ({
  key: 'support.motion.rate',
  group: 'Motion of the support',
  label: 'Rate',
  unit,
  values,
})
const span = (from: number | string, to: number | string, scale: 'linear' | 'log' = 'linear') => ({
  key: 'support.motion.rate',
  from,
  to,
  count: 3,
  scale,
})

describe('the side of a map', () => {
  it('is in the unit in which it was asked for', () => {
    const rpm = Math.PI / 30
    const side = sideOf(axis([10 * rpm, 20 * rpm, 30 * rpm]), span('10 rpm', '30 rpm'))
    expect(side.unit).toBe('rpm')
    side.values.forEach((value, i) => {
      expect(value).toBeCloseTo(10 * (i + 1), 12)
    })
  })

  it('is in that unit also where it begins at 0', () => {
    const side = sideOf(axis([0, 0.05, 0.1], 'm'), span('0 cm', '10 cm'))
    expect(side.values).toEqual([0, 5, 10])
  })

  it('is in SI where two units were named, or none', () => {
    expect(sideOf(axis([1, 2, 3]), span('1 rad/s', '3 1/s')).unit).toBe('rad/s')
    expect(sideOf(axis([1, 2, 3]), span(1, 3)).values).toEqual([1, 2, 3])
  })

  it('has its first value in the middle of its first field, and finds the field again', () => {
    for (const scale of ['linear', 'log'] as const) {
      const values = scale === 'log' ? [0.1, 1, 10, 100] : [1, 2, 3, 4]
      const side = sideOf(axis(values, ''), span(values[0]!, values[3]!, scale))
      expect(placeOf(side, values[0]!)).toBeCloseTo(1 / 8, 12)
      values.forEach((value, i) => {
        expect(fieldAt(side, placeOf(side, value))).toBe(i)
      })
    }
  })
})

describe('ticks', () => {
  it('are round numbers within the range', () => {
    expect(roundNumbers(40, 200, 6)).toEqual([50, 100, 150, 200])
    expect(roundNumbers(0, 1e-4, 6)).toEqual([0, 2e-5, 4e-5, 6e-5, 8e-5, 1e-4])
    expect(roundNumbers(-0.3, 0.31, 5)).toEqual([-0.2, 0, 0.2])
  })

  it('are decades and their parts on a logarithmic scale', () => {
    const side = sideOf(axis([0.05, 0.2, 1], ''), span(0.05, 1, 'log'))
    expect(ticksOf(side, 6).map(({ text }) => text)).toEqual(['0.05', '0.1', '0.2', '0.5', '1'])
  })
})

describe('the name of a number', () => {
  it('is its label, with the table that it stands in, in the language of the page', () => {
    const rate = { key: 'support.motion.rate', group: 'Motion of the support', label: 'Rate' }
    expect(nameOf(rate)).toBe('Motion of the support: Rate')
    expect(nameOf({ key: 'gravity', group: '', label: 'Gravity' })).toBe('Gravity')
    speak('de', german)
    expect(nameOf(rate)).toBe('Bewegung der Unterlage: Winkel\u00adgeschwindigkeit')
    speak('en', {})
  })
})

describe('units', () => {
  it('are printed', () => {
    expect([inPrint('m/s^2'), inPrint('kg*m^2'), inPrint('m s-1'), labelOf('gravity', '')]).toEqual([
      'm/s²',
      'kg m²',
      'm s⁻¹',
      'gravity',
    ])
  })
})

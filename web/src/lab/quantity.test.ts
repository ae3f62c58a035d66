import { describe, expect, it } from 'vitest'
import { PARTS } from './parts.fixture'
import { amount, brief, parse, show, stepped, suited, toSI, write } from './quantity'

const { length = {}, velocity = {}, density = {}, number = {}, angle = {} } = PARTS.units
const turning = PARTS.units['angular velocity'] ?? {}

describe('a quantity as text', () => {
  it('is taken apart as it was written', () => {
    expect(parse('33.3 rpm')).toEqual({ number: 33.3, digits: '33.3', unit: 'rpm' })
    expect(parse('-4cm')).toEqual({ number: -4, digits: '-4', unit: 'cm' })
    expect(parse('−2.50 m/s')).toEqual({ number: -2.5, digits: '-2.50', unit: 'm/s' })
    expect(parse('1e-3 kg*m^2').unit).toBe('kg*m^2')
    expect(parse('3°').unit).toBe('deg')
    expect(parse(0.25)).toEqual({ number: 0.25, digits: '0.25', unit: '' })
    for (const none of ['', 'abc', '-', '2*sin(t)x', undefined, null, ['1 m']]) expect(toSI(none, length)).toBeNull()
  })
  it('is SI where the unit is known, and left to the server where not', () => {
    expect(toSI('25 mm', length)).toBeCloseTo(0.025, 15)
    expect(toSI('2 in', length)).toBeCloseTo(0.0508, 15)
    expect(toSI('33.3 rpm', turning)).toBeCloseTo(3.48716785, 8)
    expect(toSI('7.8 g/cm³', density)).toBeCloseTo(7800, 9)
    expect(toSI(45, turning)).toBe(45)
    expect(toSI('0.3', number)).toBe(0.3)
    for (const units of [length, angle, turning, density]) expect(toSI('45', units)).toBeNull()
    expect(toSI('2 furlong', length)).toBeNull()
    expect(toSI('2 kg', length)).toBeNull()
  })
  it('is written with few digits, in the unit asked for', () => {
    expect(write(3.4871678454846706, turning, 'rpm')).toBe('33.3 rpm')
    expect(write(0.1 + 0.2, length, '')).toBe(0.3)
    expect(write(1e-7, length, 'm')).toBe('1e-7 m')
    expect(write(0, velocity, 'm/s')).toBe('0 m/s')
  })
  it('steps along round numbers', () => {
    expect(stepped(33.3, 1)).toBe(34)
    expect(stepped(33.3, -1)).toBe(33)
    expect(stepped(0, 1)).toBe(0.1)
    expect(stepped(0.1, -1)).toBe(0.09)
    expect(stepped(25, 1, 10)).toBe(30)
    expect(stepped(25, -1, 0.1)).toBe(24.9)
    expect(stepped(-33.3, 1)).toBe(-33)
  })
})

it('numbers are shown for people', () => {
  expect(show(0.9963336701)).toBe('0.9963')
  expect(show(-4.2)).toBe('−4.2')
  expect(show(1.11e-16, 2)).toBe('1.1×10⁻¹⁶')
  expect(show(0)).toBe('0')
  expect(show(null)).toBe('–')
  expect(show(Number.NaN)).toBe('–')
})

it.each([
  ['33.30', '33.30'],
  ['9.80665', '9.807'],
  ['-0.06170474949657112', '-0.06170'],
  ['2.9942857e-6', '2.994e-6'],
  ['-0.0000029942857', '-2.994e-6'],
  ['0.000000001', '1e-9'],
  ['123456789', '1.235e+8'],
  ['12345', '12345'],
  ['0', '0'],
  ['0.0000000', '0'],
  ['3.4*(1 - exp(-t))', '3.4*(1 - exp(-t))'],
  ['', ''],
])('shows %s as %s in a small box', (digits, shown) => {
  expect(brief(digits)).toBe(shown)
})

it('takes a prefix where a number would need a power of ten, and leaves others as they are written', () => {
  const inertia = { 'kg*m^2': 1, 'g*m^2': 1e-3, 'mg*m^2': 1e-6, 'g*cm^2': 1e-7 }
  expect(suited(2.9942857e-6, 'kg*m^2', inertia)).toBe('mg*m^2')
  expect(suited(2e-4, 'kg*m^2', inertia)).toBe('mg*m^2')
  expect(suited(0.0016, 'kg*m^2', inertia)).toBe('kg*m^2')
  expect(suited(0, 'kg*m^2', inertia)).toBe('kg*m^2')
  expect(suited(2e-6, 'slug', inertia)).toBe('slug')
})

it('knows a unit however it is spelt', () => {
  expect(['3 kg m²', '3 mN m', '3 kg m^2', '3 g/cm³', '3 °'].map((text) => parse(text).unit)).toEqual([
    'kg*m^2',
    'mN*m',
    'kg*m^2',
    'g/cm^3',
    'deg',
  ])
})

it('writes a number with its unit, degrees by their sign', () => {
  expect(amount(-3, 'deg')).toBe('−3°')
  expect(amount(33.3, 'rpm')).toBe('33.3 rpm')
  expect(amount(2, '')).toBe('2')
})

/** Texts such as "33.3 rpm" taken apart and put together. Only the server decides what they mean; this is for sliders. */
import type { Json } from './scenario'

/** The units of a dimension, the SI unit first, and how many SI units each is. */
export type Units = Record<string, number>

const NUMBER = /^\s*([+\-−]?(?:\d[\d_]*\.?[\d_]*|\.\d+)(?:[eE][+\-−]?\d{1,4})?)\s*(.*?)\s*$/s
const SPELLINGS: Record<string, string> = {
  '°': 'deg',
  degree: 'deg',
  degrees: 'deg',
  '"': 'in',
  inch: 'in',
  inches: 'in',
  '1/s': 'rad/s',
}

/** A unit as the table of units writes it: "mN m" as "mN*m", "kg m²" as "kg*m^2". */
function spelt(unit: string): string {
  return (
    SPELLINGS[unit] ??
    unit
      .replace('²', '^2')
      .replace('³', '^3')
      .replace(/(\w) (?=\w)/g, '$1*')
  )
}

export interface Written {
  /** The number, or null where the text is none: a formula, a word, nonsense. */
  number: number | null
  /** As it was written: "33.3". */
  digits: string
  unit: string
}

/** Take a quantity apart: a bare number has no unit. */
export function parse(value: Json | undefined): Written {
  if (typeof value === 'number') return { number: value, digits: shortest(value), unit: '' }
  if (typeof value !== 'string') return { number: null, digits: '', unit: '' }
  const match = NUMBER.exec(value)
  if (!match) return { number: null, digits: value, unit: '' }
  const digits = (match[1] ?? '').replace('−', '-')
  const written = match[2] ?? ''
  // What begins otherwise is a formula: 3.5*(1 - exp(-t)).
  if (!/^([\p{L}°"%]|1\/s)?/u.exec(written)?.[0] && written) return { number: null, digits: value, unit: '' }
  return { number: Number(digits.replaceAll('_', '')), digits, unit: spelt(written) }
}

/** The SI unit, which a bare number has. */
export function siUnit(units: Units): string {
  return Object.keys(units)[0] ?? ''
}

/** How many SI units it is: of a bare number itself. Null where the server refuses it, or may know more than this table. */
export function toSI(value: Json | undefined, units: Units): number | null {
  const { number, unit } = parse(value)
  if (number === null || !Number.isFinite(number)) return null
  if (typeof value === 'number') return number
  const factor = units[unit] // of text without a unit only where none is missing: "45" may be rad/s or rpm
  return factor === undefined ? null : number * factor
}

/** The unit in which a number has few digits before and behind its point, where its own gives it a power of ten. */
export function suited(number: number, unit: string, units: Units): string {
  const size = Math.abs(number)
  const own = units[unit]
  if (own === undefined || size === 0 || (size >= 1e-3 && size < 1e5)) return unit
  const counted = (name: string) => (size * own) / units[name]!
  const fit = Object.keys(units).filter((name) => counted(name) >= 1)
  return fit.reduce((best, name) => (counted(name) < counted(best) ? name : best), fit[0] ?? unit)
}

/** A quantity in words: 3.487 rad/s as "33.3 rpm". Without a unit it stays a bare number. */
export function write(si: number, units: Units, unit: string, digits = 4): number | string {
  const factor = units[unit] ?? 1
  const number = rounded(si / factor, digits)
  return unit === '' ? number : `${shortest(number)} ${unit}`
}

/** Rounded to significant digits, without the noise of binary fractions. */
export function rounded(value: number, digits: number): number {
  return value === 0 || !Number.isFinite(value) ? 0 : Number(value.toPrecision(digits))
}

function shortest(value: number): string {
  return Math.abs(value) >= 1e-4 || value === 0 ? String(value) : value.toExponential()
}

/** Digits as written where they are few, else four of them: what fits a small box, and what an eye takes in. */
export function brief(digits: string): string {
  const number = Number(digits)
  const many = digits.replace(/e.*/i, '').replace(/\D/g, '').replace(/^0+/, '').length
  if (!Number.isFinite(number) || (many <= 5 && digits.length <= 8)) return digits
  const size = Math.abs(number)
  const shown = Math.max(1, Math.min(4, many))
  return size !== 0 && (size < 1e-3 || size >= 1e5) ? number.toExponential(shown - 1) : number.toPrecision(shown)
}

/** The size of an arrow key's step: a one in the last place but one of what is shown, a tenth of the number at most. */
export function stepFor(number: number): number {
  if (number === 0) return 0.1
  const decade = 10 ** Math.floor(Math.log10(Math.abs(number)))
  return decade / 10
}

/** One step up or down, on the grid of steps: 33.3 goes to 34, not to 34.3. */
export function stepped(number: number, direction: number, scale = 1): number {
  const step = stepFor(number) * scale
  const grid = number / step
  const next = direction > 0 ? Math.floor(grid + 1 + 1e-9) : Math.ceil(grid - 1 - 1e-9)
  return rounded(next * step, 12)
}

/** A number for people: four digits, true minus sign, powers of ten where it is very small or large. */
export function show(value: number | null | undefined, digits = 4): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–'
  const size = Math.abs(value)
  if (value !== 0 && (size < 1e-3 || size >= 1e5)) {
    const [mantissa = '', exponent = '0'] = value.toExponential(Math.min(digits - 1, 3)).split('e')
    return `${mantissa.replace('-', '−')}×10${superscript(Number(exponent))}`
  }
  return Number(value.toPrecision(digits)).toString().replace('-', '−')
}

/** A number with its unit, for people: 33.3 rpm, 3°. */
export function amount(value: number | null | undefined, unit: string, digits = 4): string {
  return unit === 'deg' ? `${show(value, digits)}°` : `${show(value, digits)} ${unit}`.trim()
}

function superscript(number: number): string {
  const signs: Record<string, string> = { '-': '⁻' }
  return [...String(number)].map((c) => signs[c] ?? '⁰¹²³⁴⁵⁶⁷⁸⁹'[Number(c)] ?? c).join('')
}

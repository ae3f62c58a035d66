/** How long an arrow is: round scales that can be said in words, and numbers as they are read. */

/** The nearest of 1, 2 and 5 times a power of ten that is not smaller. */
export function roundUp(value: number): number {
  if (!(value > 0) || !Number.isFinite(value)) return 1
  const power = 10 ** Math.floor(Math.log10(value) + 1e-9)
  const digit = value / power
  const step = [1, 2, 5, 10].find((candidate) => digit <= candidate * (1 + 1e-9)) ?? 10
  return step * power
}

export interface ArrowScale {
  /** m of arrow for one unit of the quantity. */
  readonly length: number
  /** Said in words: "0.2 m/s per 10 cm". */
  readonly words: string
}

/** The scale by which a quantity of this size makes an arrow of about this length, m. */
export function arrowScale(size: number, unit: string, length: number): ArrowScale {
  const reference = roundUp(0.4 * length)
  const amount = roundUp((size * reference) / length)
  return { length: reference / amount, words: `${shortNumber(amount)} ${unit} per ${lengthWords(reference)}` }
}

/** A typical large value of a vector's length over a run: an impact's peak must not make all else vanish. */
export function typicalSize(column: ArrayLike<number> | undefined): number {
  if (!column) return 0
  const sizes: number[] = []
  const step = 3 * Math.max(1, Math.floor(column.length / 3 / 500))
  for (let i = 0; i + 2 < column.length; i += step) {
    const size = Math.hypot(column[i]!, column[i + 1]!, column[i + 2]!)
    if (Number.isFinite(size)) sizes.push(size)
  }
  sizes.sort((a, b) => a - b)
  return sizes[Math.floor(0.95 * (sizes.length - 1))] ?? 0
}

export function lengthWords(metres: number): string {
  if (metres < 0.01) return `${shortNumber(metres * 1000)} mm`
  if (metres < 1) return `${shortNumber(metres * 100)} cm`
  return `${shortNumber(metres)} m`
}

/** Three figures, without an exponent where that can be read. */
export function shortNumber(value: number): string {
  if (value === 0) return '0'
  const size = Math.abs(value)
  if (size >= 1e5 || size < 1e-3) {
    const [digits, power] = value.toExponential(2).split('e') as [string, string]
    return `${String(Number(digits)).replace('-', '−')} × 10${superscript(Number(power))}`
  }
  return String(Number(value.toPrecision(3))).replace('-', '−')
}

/** Always as many places, so that a running number does not jump about. */
export function steadyNumber(value: number, size: number): string {
  if (!Number.isFinite(value)) return '–'
  const places = Math.min(6, Math.max(0, 2 - Math.floor(Math.log10(Math.max(Math.abs(size), 1e-6)))))
  return withPlaces(value, places)
}

/** So many places, with a minus sign unless all of them are zero. */
export function withPlaces(value: number, places: number): string {
  return (Number(value.toFixed(places)) + 0).toFixed(places).replace('-', '−')
}

const SUPERSCRIPTS = '⁰¹²³⁴⁵⁶⁷⁸⁹'

function superscript(power: number): string {
  const digits = [...String(Math.abs(power))].map((digit) => SUPERSCRIPTS[Number(digit)]).join('')
  return (power < 0 ? '⁻' : '') + digits
}

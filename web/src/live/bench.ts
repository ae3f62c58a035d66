/** The sliders of a live page, with a box for each number. */
import { shownDigits, t } from '../languages/translate'
import { element, handOver, put } from '../viewer/elements'
import { shortNumber } from '../viewer/quantities'
import type { SliderHeader } from './header'
import { typedNumber } from './typed'

const STEPS = 200 // of a slider by the keyboard
const MOST = 40 // letters of what was typed that are said again

/** Of each slider. */
interface Row {
  range: HTMLInputElement
  field: HTMLInputElement
  /** What is wrong with a number that was typed, or why another stands there. */
  message: HTMLElement
}

export class Bench {
  readonly element: HTMLElement
  readonly values: number[]
  private readonly rows: Row[]
  private readonly back = element('button', 'live-back', { type: 'button' }, 'As in the file')

  constructor(
    private readonly sliders: readonly SliderHeader[],
    private readonly changed: () => void,
  ) {
    this.values = sliders.map(({ value }) => value)
    this.rows = sliders.map((slider, i) => this.row(slider, i))
    this.back.addEventListener('click', () => {
      sliders.forEach(({ value }, i) => {
        this.set(i, value)
      })
      changed()
    })
    const parts = sliders.map((slider, i) => shown(slider, this.rows[i]!, i))
    this.element = element('div', 'live-bench', {}, ...parts, ...(sliders.length ? [this.back] : []))
    sliders.forEach(({ value }, i) => {
      this.set(i, value)
    })
  }

  /** Whether anything stands otherwise than in the file. */
  get moved(): boolean {
    return this.sliders.some(({ value }, i) => value !== this.values[i])
  }

  set disabled(disabled: boolean) {
    for (const { range, field } of this.rows) for (const part of [range, field]) part.disabled = disabled
    this.back.disabled = disabled || !this.moved
  }

  private row({ low, high, factor, label, unit }: SliderHeader, i: number): Row {
    const [min, max] = [low / factor, high / factor]
    const step = (max - min) / STEPS
    const range = element('input', '', {
      type: 'range',
      id: `live-${i}`,
      min: `${min}`,
      max: `${max}`,
      step: `${step}`,
    })
    const field = element('input', '', {
      type: 'text',
      inputmode: 'decimal',
      'aria-label': `${label}${unit && `, ${unit}`}`,
      'aria-describedby': `live-${i}-message`,
    })
    const message = element('p', 'live-message', { id: `live-${i}-message`, role: 'alert' })
    range.addEventListener('input', () => {
      this.set(i, Math.min(high, Math.max(low, range.valueAsNumber * factor)), false)
      this.changed()
    })
    field.addEventListener('change', () => {
      const said = field.value.trim()
      const typed = typedNumber(said, unit, t(unit))
      const value = typed === null ? this.values[i]! : Math.min(high, Math.max(low, typed * factor))
      this.set(i, value)
      if (typed !== null) this.changed()
      if (typed === null) message.textContent = unread(this.sliders[i]!, said, value)
      else if (shortNumber(value / factor) !== shortNumber(typed)) message.textContent = beyond(this.sliders[i]!, typed)
      put(field, 'aria-invalid', String(typed === null))
    })
    return { range, field, message }
  }

  private set(i: number, value: number, slide = true): void {
    const { factor, unit } = this.sliders[i]!
    const { range, field, message } = this.rows[i]!
    this.values[i] = value
    message.textContent = ''
    field.removeAttribute('aria-invalid')
    const text = shortNumber(value / factor)
    field.value = shownDigits(text)
    if (slide) range.value = String(value / factor)
    put(range, 'aria-valuetext', `${text} ${unit}`.trim())
    if (!this.moved) handOver(this.back, this.rows[0]!.range)
    this.back.disabled = !this.moved
  }
}

/** The number as it is shown, with its unit. */
function amount(value: number, unit: string): string {
  return `${shownDigits(shortNumber(value))} ${t(unit)}`.trim()
}

/** What was typed stays as it was typed, in any language. */
function unread({ label, unit, factor }: SliderHeader, said: string, value: number): string {
  const values = { label: t(label), unit: t(unit), value: amount(value / factor, unit) }
  if (said === '') return t('“{label}” needs a number; the box was empty. It stays at {value}.', values)
  const typed = said.length > MOST ? `${said.slice(0, MOST)}…` : said
  return unit
    ? t('“{label}” needs a number in {unit}, and “{typed}” is none. It stays at {value}.', { ...values, typed })
    : t('“{label}” needs a number, and “{typed}” is none. It stays at {value}.', { ...values, typed })
}

function beyond({ label, unit, factor, low, high }: SliderHeader, typed: number): string {
  const [from, to] = [shownDigits(shortNumber(low / factor)), amount(high / factor, unit)]
  const values = { label: t(label), from, to, typed: amount(typed, unit) }
  return typed * factor < low
    ? t('“{label}” goes from {from} to {to}: {typed} is too small, and the least is taken.', values)
    : t('“{label}” goes from {from} to {to}: {typed} is too large, and the most is taken.', values)
}

function shown({ label, group, unit }: SliderHeader, { range, field, message }: Row, i: number): HTMLElement {
  const name = element('label', '', { for: `live-${i}` }, label, ' ', element('small', '', {}, group))
  const value = element('span', 'live-value', {}, field, element('span', 'live-unit', {}, unit))
  return element('div', 'live-slider', {}, name, value, range, message)
}

/** The sliders of a live page. */
import { shownDigits } from '../languages/translate'
import { element, handOver, put } from '../viewer/elements'
import { shortNumber } from '../viewer/quantities'
import type { SliderHeader } from './header'

const STEPS = 200 // of a slider by the keyboard

export class Bench {
  readonly element: HTMLElement
  readonly values: number[]
  private readonly rows: { range: HTMLInputElement; field: HTMLInputElement }[]
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

  private row({ low, high, factor, label, unit }: SliderHeader, i: number): (typeof this.rows)[number] {
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
    })
    range.addEventListener('input', () => {
      this.set(i, Math.min(high, Math.max(low, range.valueAsNumber * factor)), false)
      this.changed()
    })
    field.addEventListener('change', () => {
      const typed = Number(field.value.replace(',', '.').replace('−', '-'))
      if (field.value.trim() && Number.isFinite(typed)) {
        this.set(i, Math.min(high, Math.max(low, typed * factor)))
        this.changed()
      } else this.set(i, this.values[i]!)
    })
    return { range, field }
  }

  private set(i: number, value: number, slide = true): void {
    const { factor, unit } = this.sliders[i]!
    const { range, field } = this.rows[i]!
    this.values[i] = value
    const text = shortNumber(value / factor)
    field.value = shownDigits(text)
    if (slide) range.value = String(value / factor)
    put(range, 'aria-valuetext', `${text} ${unit}`.trim())
    if (!this.moved) handOver(this.back, this.rows[0]!.range)
    this.back.disabled = !this.moved
  }
}

function shown(
  { label, group, unit }: SliderHeader,
  { range, field }: { range: HTMLInputElement; field: HTMLInputElement },
  i: number,
): HTMLElement {
  const name = element('label', '', { for: `live-${i}` }, label, ' ', element('small', '', {}, group))
  const value = element('span', 'live-value', {}, field, element('span', 'live-unit', {}, unit))
  return element('div', 'live-slider', {}, name, value, range)
}

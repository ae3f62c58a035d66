/** The few controls of these pages: a slider with its value, a choice of some, a button. */
import { put, say } from '../../../viewer/elements'
import { h, uniqueId } from '../../dom'

export interface SliderOptions {
  label: string
  min: number
  max: number
  step: number
  value: number
  /** The value in words, with its unit: "33.3 rpm". */
  words(value: number): string
  change(value: number): void
  testid?: string
}

export interface Slider {
  readonly element: HTMLElement
  readonly input: HTMLInputElement
  /** Show a value without telling anyone. */
  set(value: number): void
}

export function slider(options: SliderOptions): Slider {
  const id = uniqueId('slider')
  const { min, max, step, value, words, change, label, testid } = options
  const output = h('output', { for: id, class: 'number' })
  const input = h('input', { id, class: 'slider', type: 'range', min, max, step, value, 'data-testid': testid })
  function told(): void {
    const now = Number(input.value)
    say(output, words(now))
    put(input, 'aria-valuetext', words(now))
    const at = (place: number) => `${(100 * (place - min)) / (Number(input.max) - min)}%`
    const zero = Math.max(min, Math.min(0, Number(input.max)))
    input.style.setProperty('--from', at(Math.min(now, zero)))
    input.style.setProperty('--to', at(Math.max(now, zero)))
  }
  input.addEventListener('input', () => {
    told()
    change(Number(input.value))
  })
  told()
  return {
    element: h('div', { class: 'dial' }, h('label', { for: id }, label), output, input),
    input,
    set(next) {
      input.value = String(next)
      told()
    },
  }
}

export interface Choice<Value extends string> {
  readonly element: HTMLElement
  readonly value: Value
  set(value: Value): void
}

/** One of a few, side by side: radio buttons, so that arrow keys choose. */
export function choice<Value extends string>(
  label: string,
  options: readonly (readonly [Value, string])[],
  value: Value,
  change: (value: Value) => void,
): Choice<Value> {
  const name = uniqueId('choice')
  let current = value
  const inputs = options.map(([one]) =>
    h('input', {
      type: 'radio',
      name,
      value: one,
      checked: one === value,
      onchange: () => {
        current = one
        change(one)
      },
    }),
  )
  const parts = options.map(([, words], i) => h('label', {}, inputs[i]!, h('span', {}, words)))
  return {
    element: h('fieldset', { class: 'choice' }, h('legend', {}, label), h('div', { class: 'choice-options' }, parts)),
    get value() {
      return current
    },
    set(next) {
      current = next
      inputs.forEach((input) => {
        input.checked = input.value === next
      })
    },
  }
}

export type ButtonKind = 'primary' | 'plain' | 'quiet'

const KINDS: Readonly<Record<ButtonKind, string>> = { primary: 'primary', plain: 'button', quiet: 'quiet' }

export function button(
  words: string,
  press: () => void,
  kind: ButtonKind = 'plain',
  testid?: string,
): HTMLButtonElement {
  return h('button', { type: 'button', class: KINDS[kind], onclick: press, 'data-testid': testid }, words)
}

/** A switch among others: on or off. */
export function toggle(words: string, on: boolean, change: (on: boolean) => void): HTMLElement {
  const input = h('input', { type: 'checkbox', checked: on, onchange: () => change(input.checked) })
  return h('label', { class: 'toggle' }, input, h('span', {}, words))
}

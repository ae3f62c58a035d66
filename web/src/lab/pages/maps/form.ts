/** What a map is of: the two numbers, how far they go, and what is measured. */
import { shownDigits, t, typedDigits } from '../../../languages/translate'
import { say } from '../../../viewer/elements'
import type { MapRequest, ScenarioNumber, Span } from '../../api'
import { fill, h, uniqueId } from '../../dom'
import { rounded } from '../../quantity'
import { button } from '../parts/controls'
import { labelOf, nameOf } from './axes'

export interface Form {
  readonly element: HTMLElement
  show(request: MapRequest, numbers: readonly ScenarioNumber[]): void
  /** Say what is wrong, beside the field that is meant. */
  wrong(message: string | null, key?: string | null): void
}

/** A first span of a number: from half of it to twice as much; about 0 where it is 0. */
export function spanOf({ key, value, unit }: ScenarioNumber): Span {
  const written = (number: number) => (unit ? `${rounded(number, 4)} ${unit}` : rounded(number, 4))
  const [from, to] = value === 0 ? [-1, 1] : [value / 2, value * 2]
  return { key, from: written(from), to: written(to), count: 24, scale: 'linear' }
}

/** The two numbers that a map of any scenario begins with: of its start, or else the first that are not 0. */
export function firstSpans(numbers: readonly ScenarioNumber[]): [Span, Span] | null {
  const some = numbers.filter(({ value }) => value !== 0)
  const ordered = [
    ...some.filter(({ key }) => key.startsWith('start.')),
    ...some.filter(({ key }) => key.startsWith('support.')),
    ...some,
    ...numbers,
  ]
  const [first, second] = ordered.filter((one, i) => ordered.indexOf(one) === i)
  return first && second ? [spanOf(first), spanOf(second)] : null
}

export function createForm(figures: readonly string[], asked: (request: MapRequest) => void): Form {
  const message = h('p', { class: 'map-wrong', role: 'alert', hidden: true, 'data-testid': 'map-wrong' })
  const list = uniqueId('figures')
  const measure = h('input', { type: 'text', list, spellcheck: 'false', 'data-testid': 'map-measure' })
  const sides = [createSide('Across'), createSide('Upwards')] as const
  let scenario: MapRequest['scenario'] | undefined
  let known: readonly ScenarioNumber[] = []

  const element = h(
    'form',
    { class: 'map-form', novalidate: true },
    sides.map((side) => side.element),
    h(
      'fieldset',
      {},
      h('legend', {}, 'Colour'),
      h('label', { class: 'map-field map-field-wide' }, h('span', {}, 'What is measured of each run'), measure),
      h(
        'datalist',
        { id: list },
        figures.map((figure) => h('option', { value: figure })),
      ),
      h(
        'p',
        { class: 'map-hint' },
        'A figure such as ',
        h('code', {}, 'turned-over'),
        ', or one of a formula: ',
        h('code', {}, 'max hypot(x, y)'),
        ', ',
        h('code', {}, 'first wz'),
        '.',
      ),
    ),
    message,
    button('Compute this map', () => element.requestSubmit(), 'primary', 'map-draw'),
  )
  element.addEventListener('submit', (event) => {
    event.preventDefault()
    if (!scenario) return
    const [across, up] = sides
    asked({ scenario, over: [across.span, up.span], measure: measure.value.trim() })
  })

  return {
    element,
    show(request, numbers) {
      scenario = request.scenario
      known = numbers
      sides.forEach((side, i) => {
        side.show(request.over[i]!, numbers)
      })
      measure.value = request.measure
    },
    wrong(text, key = null) {
      message.hidden = text === null
      // In the words of the labels above it.
      say(
        message,
        known.reduce(
          (said, one) => said.replaceAll(`over.${one.key}`, t('“{label}”', { label: nameOf(one) })),
          text ?? '',
        ),
      )
      const fields = [...sides.map((side) => [side.key, side.field] as const), ['', measure] as const]
      for (const [name, field] of fields) {
        const meant = text !== null && (name ? (key ?? '').startsWith(`over.${name}`) : !!key?.startsWith('measure'))
        if (meant) field.setAttribute('aria-invalid', 'true')
        else field.removeAttribute('aria-invalid')
      }
    },
  }
}

interface SideOfForm {
  readonly element: HTMLElement
  readonly span: Span
  readonly key: string
  readonly field: HTMLElement
  show(span: Span, numbers: readonly ScenarioNumber[]): void
}

function createSide(name: string): SideOfForm {
  const key = h('select', {})
  const from = h('input', { type: 'text', spellcheck: 'false', autocomplete: 'off' })
  const to = h('input', { type: 'text', spellcheck: 'false', autocomplete: 'off' })
  const count = h('input', { type: 'text', inputmode: 'numeric', autocomplete: 'off' })
  const scale = h('select', {}, h('option', { value: 'linear' }, 'evenly'), h('option', { value: 'log' }, 'by ratios'))
  let known: readonly ScenarioNumber[] = []
  key.addEventListener('change', () => {
    const number = known.find((one) => one.key === key.value)
    if (number) put(spanOf(number))
  })

  function put(span: Span): void {
    from.value = shownDigits(String(span.from))
    to.value = shownDigits(String(span.to))
    count.value = String(span.count)
    scale.value = span.scale
  }

  const field = (words: string, input: HTMLElement, wide = false) =>
    h('label', { class: wide ? 'map-field map-field-wide' : 'map-field' }, h('span', {}, words), input)
  return {
    element: h(
      'fieldset',
      {},
      h('legend', {}, name),
      field('Number of the scenario', key, true),
      field('from', from),
      field('to', to),
      field('fields', count),
      field('spaced', scale),
    ),
    get span(): Span {
      return {
        key: key.value,
        from: written(from.value),
        to: written(to.value),
        count: /^\s*\d+\s*$/.test(count.value) ? Number(count.value) : 0,
        scale: scale.value === 'log' ? 'log' : 'linear',
      }
    },
    get key() {
      return key.value
    },
    field: from,
    show(span, numbers) {
      known = numbers
      fill(key, options(numbers))
      key.value = span.key
      put(span)
    },
  }
}

/** The numbers to choose from, those of each table together. */
function options(numbers: readonly ScenarioNumber[]): HTMLElement[] {
  const groups = new Set(numbers.map(({ group }) => group))
  return [...groups].flatMap((group) => {
    const some = numbers.filter((one) => one.group === group)
    const each = some.map((one) => h('option', { value: one.key, title: one.key }, labelOf(t(one.label), one.unit)))
    return group ? [h('optgroup', { label: group }, each)] : each
  })
}

/** A bare number as a number: it is SI. With the decimal sign that the reader typed. */
function written(text: string): string | number {
  const trimmed = typedDigits(text).trim()
  return trimmed !== '' && Number.isFinite(Number(trimmed)) ? Number(trimmed) : trimmed
}

/** A table: what theory predicts beside what the motion shows. */
import type { Finding } from '../../../viewer/scene'
import { fill, h } from '../../dom'
import { formula } from '../../math'
import { show } from '../../quantity'

/** Texts may stand for numbers that are not one number: a direction, a fraction. */
export interface Row {
  name: string
  symbol?: string | undefined
  predicted: number | string | null
  measured: number | string | null
  unit?: string | undefined
}

export interface Numbers {
  readonly element: HTMLElement
  set(rows: (Row | undefined)[]): void
}

export function rowOf(found: Finding | undefined, scale = 1, unit = found?.unit): Row | undefined {
  if (!found) return undefined
  const scaled = (value: number | null) => (value === null ? null : value * scale)
  const { name, symbol, predicted, measured } = found
  return { name, symbol, predicted: scaled(predicted), measured: scaled(measured), unit }
}

export function createNumbers(caption = 'Theory beside measurement'): Numbers {
  const body = h('tbody')
  const heads = h('tr')
  const element = h(
    'table',
    { class: 'versus', 'data-testid': 'numbers' },
    h('caption', { class: 'sr-only' }, caption),
    h('thead', {}, heads),
    body,
  )
  return {
    element,
    set(rows) {
      const given = rows.filter((row) => row !== undefined)
      const predicted = given.some((row) => row.predicted !== null)
      // Nothing is predicted of what is only read off: no heading over an empty column.
      fill(heads, h('td'), predicted ? head('predicted') : h('td'), head('measured'))
      fill(body, ...given.map(line))
    },
  }
}

function head(words: string): HTMLElement {
  return h('th', { scope: 'col' }, words)
}

function line({ name, symbol, predicted, measured, unit }: Row): HTMLElement {
  return h(
    'tr',
    { 'data-symbol': symbol },
    h('th', { scope: 'row' }, h('span', { class: 'versus-name' }, name), symbol ? formula(symbol) : null),
    predicted === null ? h('td') : cell(predicted, unit),
    cell(measured, unit),
  )
}

function cell(value: number | string | null, unit = ''): HTMLElement {
  const text = typeof value === 'string' ? value : show(value)
  const raw = typeof value === 'number' ? value : null
  return h('td', { 'data-value': raw }, text, unit && value !== null ? h('span', { class: 'unit' }, ` ${unit}`) : null)
}

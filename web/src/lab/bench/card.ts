/** The verification card: each line with its mark, value and bound; what it means unfolds. */
import { say } from '../../viewer/elements'
import type { Card } from '../api'
import { fill, h } from '../dom'
import { icon } from '../icons'
import { show } from '../quantity'
import type { Json } from '../scenario'

interface Line {
  name: string
  value: number | null
  unit: string
  bound: number | null
  passed: boolean | null
  note: string
}

function lines(card: Card): Line[] {
  const figures = card.figures
  if (!Array.isArray(figures)) return []
  const number = (value: Json | undefined) => (typeof value === 'number' ? value : null)
  return figures
    .filter(
      (one): one is { [key: string]: Json | undefined } =>
        typeof one === 'object' && one !== null && !Array.isArray(one),
    )
    .map((one) => ({
      name: String(one.name ?? ''),
      value: number(one.value),
      unit: String(one.unit ?? ''),
      bound: number(one.bound),
      passed: typeof one.passed === 'boolean' ? one.passed : null,
      note: String(one.note ?? ''),
    }))
}

function verdict(passed: boolean | null): HTMLElement {
  if (passed === null)
    return h('span', { class: 'verdict verdict-none' }, h('span', { class: 'sr-only' }, 'for information'))
  const words = passed ? 'passed' : 'failed'
  return h(
    'span',
    { class: `verdict verdict-${words}` },
    icon(passed ? 'check' : 'cross'),
    h('span', { class: 'sr-only' }, words),
  )
}

function line(one: Line): HTMLElement {
  const value = `${show(one.value, 3)}${one.unit ? ` ${one.unit}` : ''}`
  return h(
    'details',
    { class: 'card-line' },
    h(
      'summary',
      {},
      verdict(one.passed),
      h('span', { class: 'card-name' }, one.name),
      h('span', { class: 'card-value' }, value),
    ),
    h(
      'div',
      { class: 'card-more' },
      one.note && h('p', {}, one.note),
      h(
        'p',
        { class: 'card-bound' },
        `value ${one.value ?? '–'} ${one.unit}`,
        one.bound === null ? '' : `, bound ${one.bound}`,
      ),
    ),
  )
}

/** `none`: there is nothing to verify; `failed`: the verification itself did not come to an end. */
export type CardState =
  | { state: 'waiting' }
  | { state: 'working' }
  | { state: 'failed' | 'none'; message: string }
  | { state: 'there'; card: Card }

export interface CardPanel {
  element: HTMLElement
  update(state: CardState): void
  /** "✓ 17", "✗ 2", "…": for the tab. */
  badge(): { text: string; kind: 'good' | 'bad' | 'busy' }
}

export function createCard(): CardPanel {
  const element = h('div', { class: 'card-panel' })
  let badge: { text: string; kind: 'good' | 'bad' | 'busy' } = { text: '…', kind: 'busy' }
  let shown: CardState['state'] | undefined

  function update(now: CardState): void {
    if (now.state === 'waiting' && shown === 'waiting') return
    shown = now.state
    element.setAttribute('aria-busy', String(now.state === 'working' || now.state === 'waiting'))
    if (now.state === 'there') {
      draw(now.card)
      return
    }
    if (now.state === 'failed' || now.state === 'none') {
      const wrong = now.state === 'failed'
      badge = wrong ? { text: '!', kind: 'bad' } : { text: '', kind: 'busy' }
      fill(element, h('p', { class: wrong ? 'alert' : 'empty' }, now.message))
      return
    }
    badge = { text: '…', kind: 'busy' }
    const words =
      now.state === 'waiting'
        ? 'The card follows when the numbers rest.'
        : 'Solving again by another route, and comparing …'
    if (element.querySelector('.card-lines')) {
      element.setAttribute('data-old', '')
      say(element.querySelector('.card-summary')!, words)
    } else fill(element, h('p', { class: 'empty working' }, words))
  }

  function draw(card: Card): void {
    element.removeAttribute('data-old')
    const all = lines(card)
    const failed = all.filter((one) => one.passed === false).length
    const passed = all.filter((one) => one.passed === true).length
    badge = failed ? { text: `✗ ${failed}`, kind: 'bad' } : { text: `✓ ${passed}`, kind: 'good' }
    const summary = failed ? `${failed} of ${failed + passed} checks fail.` : `All ${passed} checks hold.`
    fill(
      element,
      h('p', { class: `card-summary ${failed ? 'is-bad' : 'is-good'}` }, summary),
      h('p', { class: 'card-method' }, String(card.method ?? '')),
      h('div', { class: 'card-lines' }, all.map(line)),
    )
  }
  update({ state: 'waiting' })
  return { element, update, badge: () => badge }
}

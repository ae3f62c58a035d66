/** What a fit found: the verdict, the numbers with errors, and what these data cannot show. */
import type { Fitted, Named } from '../../api'
import { fill, h } from '../../dom'
import { inPrint, nameOf } from '../maps/axes'

const SIGNS: Record<Fitted['answer'], string> = { good: '✓', bad: '✗', 'cannot decide': '?' }

export function report(verdict: HTMLElement, host: HTMLElement, found: Fitted, numbers: readonly Named[]): void {
  const named = (name: string) => {
    const known = [...numbers, ...found.named].find(({ key }) => key === name)
    return known ? nameOf(known) : h('code', {}, name)
  }
  fill(
    verdict,
    h(
      'p',
      { class: 'measure-verdict', 'data-answer': found.answer, 'data-testid': 'verdict' },
      h('span', { 'aria-hidden': true }, SIGNS[found.answer]),
      found.verdict,
    ),
    found.unknown.map((sentence) =>
      h('p', { class: 'measure-unknown', 'data-testid': 'unknown' }, ...marked(sentence)),
    ),
  )
  fill(
    host,
    h(
      'div',
      { class: 'table-scroll', tabindex: '0', role: 'region', 'aria-label': 'Numbers with their errors' },
      h(
        'table',
        { class: 'versus measure-numbers', 'data-testid': 'fitted' },
        h(
          'thead',
          {},
          h(
            'tr',
            {},
            ['number', 'value', 'unit', 'remark'].map((word) => h('th', { scope: 'col' }, word)),
          ),
        ),
        h(
          'tbody',
          {},
          found.rows.map(([name, value, unit, remark]) =>
            h(
              'tr',
              {},
              h('th', { scope: 'row', title: name }, named(name)),
              [value.replaceAll('-', '−'), inPrint(unit), remark].map((cell) => h('td', {}, cell)),
            ),
          ),
        ),
      ),
    ),
    found.remarks
      .filter((remark) => !found.unknown.includes(remark))
      .map((remark) => h('p', { class: 'map-hint' }, ...marked(remark))),
    h('p', { class: 'map-hint' }, `The card of the fitted run ${found.card ? 'passes' : 'fails'}.`),
  )
}

/** Names between backticks as code. */
export function marked(sentence: string): (string | HTMLElement)[] {
  return sentence.split('`').map((part, i) => (i % 2 ? h('code', {}, part) : part))
}

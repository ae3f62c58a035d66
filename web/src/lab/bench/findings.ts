/** Predicted beside measured: a table, and the formula with the numbers put in. */
import { t } from '../../languages/translate'
import { put, say } from '../../viewer/elements'
import { beside, capital } from '../../viewer/headline'
import type { Finding, Scene } from '../../viewer/scene'
import { fill, h } from '../dom'
import { changing, formula } from '../math'
import { show } from '../quantity'

/** A relative difference in words: "1.1 × 10⁻¹⁶", "0.3 %", "exact". */
export function differenceText(difference: number | null): string {
  if (difference === null || !Number.isFinite(difference)) return '–'
  const size = Math.abs(difference)
  if (size === 0) return '0'
  return size >= 1e-4 ? `${show(size * 100, 3)} %` : show(size, 2)
}

interface Row {
  element: HTMLElement
  show(finding: Finding): void
}

/** Two lines a row: what it is, and beneath it the numbers. The roles keep it a table for whoever hears it. */
function createRow({ name, symbol, unit, note }: Finding): Row {
  const cell = () => h('td', { role: 'cell' })
  const [predicted, measured, off] = [cell(), cell(), cell()]
  const head = h(
    'th',
    { scope: 'row', role: 'rowheader' },
    h('span', { class: 'finding-name' }, name),
    symbol ? formula(symbol) : null,
    unit ? h('span', { class: 'unit' }, unit) : null,
  )
  return {
    element: h('tr', { role: 'row', title: note || null }, head, predicted, measured, off),
    show(finding) {
      say(predicted, show(finding.predicted))
      say(measured, show(finding.measured))
      say(off, differenceText(finding.difference))
      put(off, 'class', Math.abs(finding.difference ?? 1) < 1e-3 ? 'difference agrees' : 'difference')
    },
  }
}

function tableOf(rows: Row[]): HTMLElement {
  const heads = ['', 'predicted', 'measured', 'off by'].map((text) =>
    h('th', { scope: 'col', role: 'columnheader' }, text || h('span', { class: 'sr-only' }, 'quantity')),
  )
  return h(
    'table',
    { class: 'numbers findings-rows', role: 'table' },
    h('caption', { class: 'sr-only' }, 'What theory predicts, and what the run shows'),
    h('thead', { role: 'rowgroup' }, h('tr', { role: 'row' }, heads)),
    h(
      'tbody',
      { role: 'rowgroup' },
      rows.map(({ element }) => element),
    ),
  )
}

export interface Findings {
  element: HTMLElement
  update(scene: Scene): void
}

export function createFindings(derive: () => void): Findings {
  const table = h('div', { class: 'findings-table' })
  const [name, said, worked] = [h('h3'), changing(true), changing(true)]
  const button = h('button', { class: 'link', type: 'button', onclick: derive }, 'How does this follow?')
  const formulas = h('div', { class: 'formula-lines' }, said.element, worked.element)
  const law = h('div', { class: 'formula-card', hidden: true }, name, formulas, button)
  const shown = h('p', { class: 'shown' })
  const other = h('p', { class: 'shown-other' })
  const phenomenon = h('div', { class: 'phenomenon', hidden: true }, shown, other)
  const element = h('div', { class: 'findings' }, phenomenon, law, table)
  let rows: Row[] = []
  let told = ''

  /** Only what differs is put in: while a number is dragged the rows stay, and most of the page's layout with them. */
  function updateTable(findings: Finding[]): void {
    const what = JSON.stringify(findings.map((one) => [one.name, one.symbol, one.unit, one.note]))
    if (what !== told) {
      told = what
      rows = findings.map(createRow)
      const none = 'Nothing is predicted for this motion: it is computed, and the card says how well.'
      fill(table, rows.length > 0 ? tableOf(rows) : h('p', { class: 'empty' }, none))
    }
    for (const [i, row] of rows.entries()) row.show(findings[i]!)
  }

  function update({ header }: Scene): void {
    const { findings = [], formula: follows = null, headline } = header
    updateTable(findings)
    phenomenon.hidden = !headline
    if (headline) {
      say(shown, capital(headline.text))
      say(other, beside(headline))
      put(phenomenon, 'title', headline.how)
    }
    law.hidden = follows === null
    if (!follows) return
    if (name.textContent !== follows.name + (follows.source ?? ''))
      fill(name, follows.name, follows.source ? h('span', { class: 'source' }, follows.source) : null)
    said.set(follows.latex)
    worked.set(follows.numbers_latex ?? '')
    worked.element.hidden = !follows.numbers_latex
    // A path rolled without forces is geometry: there is no law of motion to derive.
    button.hidden = header.scenario !== undefined && !('support' in Object(header.scenario))
  }
  return { element, update }
}

/** What the run shows, for a screen reader. */
export function sentence({ header }: Scene): string {
  const { headline, title, duration } = header
  if (!headline) return `${title}: ${show(duration, 3)} s computed`
  return [`${t(title)}: ${t(headline.text)}`, t(beside(headline))].filter(Boolean).join(', ')
}

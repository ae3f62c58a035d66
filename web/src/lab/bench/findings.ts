/** Predicted beside measured: a table, and the formula with the numbers put in. */
import type { Finding, Scene } from '../../viewer/scene'
import { fill, h } from '../dom'
import { formula } from '../math'
import { show } from '../quantity'

/** A relative difference in words: "1.1 × 10⁻¹⁶", "0.3 %", "exact". */
export function differenceText(difference: number | null): string {
  if (difference === null || !Number.isFinite(difference)) return '–'
  const size = Math.abs(difference)
  if (size === 0) return '0'
  return size >= 1e-4 ? `${show(size * 100, 3)} %` : show(size, 2)
}

/** Two lines a row: what it is, and beneath it the numbers. The roles keep it a table for whoever hears it. */
function row(finding: Finding): HTMLElement {
  const symbol = finding.symbol ? formula(finding.symbol) : null
  const unit = finding.unit ? h('span', { class: 'unit' }, finding.unit) : null
  const name = h('span', { class: 'finding-name' }, finding.name)
  const cell = (text: string, kind?: string) => h('td', { role: 'cell', class: kind }, text)
  return h(
    'tr',
    { role: 'row', title: finding.note || null },
    h('th', { scope: 'row', role: 'rowheader' }, name, symbol, unit),
    cell(show(finding.predicted)),
    cell(show(finding.measured)),
    cell(
      differenceText(finding.difference),
      Math.abs(finding.difference ?? 1) < 1e-3 ? 'difference agrees' : 'difference',
    ),
  )
}

function tableOf(findings: Finding[]): HTMLElement {
  const heads = ['', 'predicted', 'measured', 'off by'].map((text) =>
    h('th', { scope: 'col', role: 'columnheader' }, text || h('span', { class: 'sr-only' }, 'quantity')),
  )
  return h(
    'table',
    { class: 'numbers findings-rows', role: 'table' },
    h('caption', { class: 'sr-only' }, 'What theory predicts, and what the run shows'),
    h('thead', { role: 'rowgroup' }, h('tr', { role: 'row' }, heads)),
    h('tbody', { role: 'rowgroup' }, findings.map(row)),
  )
}

export interface Findings {
  element: HTMLElement
  update(scene: Scene): void
}

export function createFindings(derive: () => void): Findings {
  const table = h('div', { class: 'findings-table' })
  const law = h('div', { class: 'formula-card', hidden: true })
  const element = h('div', { class: 'findings' }, law, table)

  function update({ header }: Scene): void {
    const { findings = [], formula: told = null } = header
    const none = 'Nothing is predicted for this motion: it is computed, and the card says how well.'
    fill(table, findings.length > 0 ? tableOf(findings) : h('p', { class: 'empty' }, none))
    law.hidden = told === null
    if (!told) return
    // A path rolled without forces is geometry: there is no law of motion to derive.
    const derived = header.scenario === undefined || 'support' in Object(header.scenario)
    const button = derived && h('button', { class: 'link', type: 'button', onclick: derive }, 'How does this follow?')
    fill(
      law,
      h('h3', {}, told.name, told.source ? h('span', { class: 'source' }, told.source) : null),
      h(
        'div',
        { class: 'formula-lines' },
        formula(told.latex, true),
        told.numbers_latex ? formula(told.numbers_latex, true) : null,
      ),
      button,
    )
  }
  return { element, update }
}

/** One sentence for a screen reader, and for the projector: the first finding that says something. */
export function headline(
  scene: Scene,
): { name: string; symbol: string; unit: string; measured: number; predicted: number | null } | null {
  const found = scene.header.findings?.find((one) => one.measured !== null)
  if (!found || found.measured === null) return null
  const { name, symbol, unit, measured, predicted } = found
  return { name, symbol, unit, measured, predicted }
}

export function sentence(scene: Scene): string {
  const found = headline(scene)
  if (!found) return `${scene.header.title}: ${show(scene.header.duration, 3)} s computed`
  const predicted = found.predicted === null ? '' : `, predicted ${show(found.predicted)}`
  return `${found.name} ${show(found.measured)} ${found.unit}${predicted}`
}

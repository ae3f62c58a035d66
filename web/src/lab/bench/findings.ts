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

function row(finding: Finding): HTMLElement {
  const symbol = finding.symbol ? formula(finding.symbol) : null
  const name = h('span', { class: 'finding-name' }, finding.name)
  const unit = finding.unit ? h('span', { class: 'unit' }, ` ${finding.unit}`) : null
  return h(
    'tr',
    {},
    h('th', { scope: 'row', title: finding.note || null }, name, symbol, unit),
    h('td', {}, show(finding.predicted)),
    h('td', {}, show(finding.measured)),
    h('td', { class: 'difference' }, differenceText(finding.difference)),
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
    const heads = ['', 'predicted', 'measured', 'off by']
    fill(
      table,
      findings.length > 0
        ? h(
            'table',
            { class: 'numbers' },
            h('caption', { class: 'sr-only' }, 'What theory predicts, and what the run shows'),
            h(
              'thead',
              {},
              h(
                'tr',
                {},
                heads.map((head) => h('th', { scope: 'col' }, head || h('span', { class: 'sr-only' }, 'quantity'))),
              ),
            ),
            h('tbody', {}, findings.map(row)),
          )
        : h(
            'p',
            { class: 'empty' },
            'Nothing is predicted for this motion: it is computed, and the card says how well.',
          ),
    )
    law.hidden = told === null
    if (!told) return
    const button = h('button', { class: 'link', type: 'button', onclick: derive }, 'How does this follow?')
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

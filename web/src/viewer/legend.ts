/** What the arrows are, how large they are now, and to what scale they are drawn. */
import type { LegendRow } from './arrows'
import { element, say } from './elements'

export class Legend {
  readonly element = element('dl', 'tr-legend', { hidden: '' })
  private kinds = ''
  private values: HTMLElement[] = []

  update(rows: readonly LegendRow[]): void {
    const kinds = rows.map(({ kind, scale, colour }) => kind + scale + colour).join()
    if (kinds !== this.kinds) this.rebuild(rows)
    this.kinds = kinds
    rows.forEach(({ value }, i) => {
      const place = this.values[i]
      if (place) say(place, value)
    })
  }

  private rebuild(rows: readonly LegendRow[]): void {
    this.element.hidden = rows.length === 0
    this.values = []
    this.element.replaceChildren()
    for (const { symbol, name, scale, colour } of rows) {
      const term = element('dt', '', { title: name }, symbol)
      term.style.setProperty('--tr-label', colour)
      const value = element('dd', 'tr-value')
      this.values.push(value)
      this.element.append(term, value, element('dd', 'tr-scale', {}, scale))
    }
  }
}

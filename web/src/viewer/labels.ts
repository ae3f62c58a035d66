/** Short words that stand beside things on the stage, as text of the page: crisp, and of the page's typeface. */
import type { Vector3 } from 'three'

export type LabelKind = 'arrow' | 'axis' | 'body' | 'sketch' | 'guide' | 'spot'

export class LabelLayer {
  readonly element: HTMLElement
  private readonly pool: HTMLElement[] = []
  private readonly asked: { text: string; x: number; y: number; colour: string; kind: LabelKind }[] = []
  private project: (place: Vector3) => { x: number; y: number } | null = () => null

  constructor(document: Document) {
    this.element = document.createElement('div')
    this.element.className = 'tr-labels'
    this.element.setAttribute('aria-hidden', 'true')
  }

  begin(project: (place: Vector3) => { x: number; y: number } | null): void {
    this.project = project
    this.asked.length = 0
  }

  /** Put a word at a place of the support frame. */
  put(text: string, place: Vector3, colour: string, kind: LabelKind): void {
    const at = this.project(place)
    if (at) this.asked.push({ text, ...at, colour, kind })
  }

  end(): void {
    this.asked.forEach(({ text, x, y, colour, kind }, i) => {
      const element = this.at(i)
      if (element.textContent !== text) element.textContent = text
      if (element.dataset.kind !== kind) element.dataset.kind = kind
      element.style.setProperty('--tr-label', colour)
      element.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`
      element.hidden = false
    })
    for (let i = this.asked.length; i < this.pool.length; i++) this.pool[i]!.hidden = true
  }

  private at(index: number): HTMLElement {
    const known = this.pool[index]
    if (known) return known
    const made = this.element.ownerDocument.createElement('span')
    made.className = 'tr-label'
    this.pool.push(made)
    this.element.append(made)
    return made
  }
}

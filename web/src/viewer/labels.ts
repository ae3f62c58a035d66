/** Short words that stand beside things on the stage, as text of the page: crisp, and of the page's typeface. */
import type { Vector3 } from 'three'
import { hide, say } from './elements'

export type LabelKind = 'arrow' | 'axis' | 'body' | 'sketch' | 'guide' | 'spot'

interface Label {
  text: string
  x: number
  y: number
  colour: string
  kind: LabelKind
}

/** A label's place and size, CSS pixels. */
export interface Box {
  x: number
  y: number
  width: number
  height: number
}

export class LabelLayer {
  readonly element: HTMLElement
  private readonly pool: HTMLElement[] = []
  private readonly asked: Label[] = []
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
    const written = this.asked.map((label, i) => this.write(label, i))
    const names = this.asked.flatMap((label, i) => (label.kind === 'body' ? [{ label, element: written[i]! }] : []))
    if (names.length > 1) {
      const boxes = names.map(({ label: { x, y }, element: { offsetWidth: width, offsetHeight: height } }) => ({
        x,
        y,
        width,
        height,
      }))
      moveApart(boxes)
      names.forEach(({ label }, i) => {
        label.y = boxes[i]!.y
      })
    }
    this.asked.forEach(({ x, y }, i) => {
      written[i]!.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`
    })
    for (let i = this.asked.length; i < this.pool.length; i++) hide(this.pool[i]!, true)
  }

  private write({ text, colour, kind }: Label, index: number): HTMLElement {
    const element = this.at(index)
    if (kind !== 'arrow') say(element, text)
    else if (element.textContent !== text) element.textContent = text // E is a field in any language, and east in some
    if (element.dataset.kind !== kind) element.dataset.kind = kind
    element.style.setProperty('--tr-label', colour)
    hide(element, false)
    return element
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

/** Move those down that lie over others, from the uppermost on, so that each can be read. */
export function moveApart(boxes: readonly Box[]): void {
  const placed: Box[] = []
  for (const box of [...boxes].sort((a, b) => a.y - b.y)) {
    for (const above of placed) {
      const beside = box.x >= above.x + above.width || above.x >= box.x + box.width
      if (!beside) box.y = Math.max(box.y, above.y + above.height)
    }
    placed.push(box)
  }
}

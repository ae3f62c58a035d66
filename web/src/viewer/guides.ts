/** What helps to read a run: axes, the guiding centre and its path, a learner's curve, the crossed fields. */
import { Group, Vector3 } from 'three'
import { Arrow } from './arrow'
import type { Frame } from './contract'
import type { LabelLayer } from './labels'
import { Line, pieces } from './lines'
import type { Scene, Triple } from './scene'
import type { Palette } from './theme'

const AXES: readonly [string, Vector3][] = [
  ['x', new Vector3(1, 0, 0)],
  ['y', new Vector3(0, 1, 0)],
  ['z', new Vector3(0, 0, 1)],
]

/** The axes of the frame that is shown. */
export class Axes {
  readonly group = new Group()
  private readonly arrows = AXES.map((_, i) => new Arrow(14 + i))
  private colours: readonly string[] = []
  private readonly origin = new Vector3()
  private readonly vector = new Vector3()

  constructor() {
    for (const arrow of this.arrows) this.group.add(arrow.group)
  }

  look({ axes }: Palette): void {
    this.colours = axes
    axes.forEach((colour, i) => {
      this.arrows[i]!.look(colour)
    })
  }

  update(
    shown: boolean,
    length: number,
    thick: number,
    labels: LabelLayer,
    toSupport: (place: Vector3) => Vector3,
    names: readonly string[] = AXES.map(([name]) => name),
  ): void {
    AXES.forEach(([, axis], i) => {
      const [arrow, name] = [this.arrows[i]!, names[i]]
      if (!shown || name === undefined) {
        arrow.hide()
        return
      }
      arrow.set(this.origin, this.vector.copy(axis).multiplyScalar(length), thick)
      labels.put(name, toSupport(this.vector.copy(arrow.tip)), this.colours[i] ?? '', 'axis')
    })
  }

  dispose(): void {
    for (const arrow of this.arrows) arrow.dispose()
  }
}

/** E and B of the charge's scene, standing at the origin. */
export class Fields {
  readonly group = new Group()
  private readonly vectors: { symbol: 'E' | 'B'; arrow: Arrow; vector: Vector3 }[] = []

  constructor({ header }: Scene, length: number) {
    for (const symbol of ['E', 'B'] as const) {
      const vector = header[symbol] && new Vector3(...header[symbol])
      if (!vector || vector.lengthSq() === 0) continue
      const arrow = new Arrow(18)
      this.group.add(arrow.group)
      this.vectors.push({ symbol, arrow, vector: vector.setLength(length) })
    }
  }

  look({ arrows }: Palette): void {
    for (const { symbol, arrow } of this.vectors) arrow.look(symbol === 'E' ? arrows.electric : arrows.magnetic)
  }

  update(thick: number, labels: LabelLayer, { arrows }: Palette): void {
    for (const { symbol, arrow, vector } of this.vectors) {
      arrow.set(new Vector3(), vector, thick)
      labels.put(symbol, arrow.tip, symbol === 'E' ? arrows.electric : arrows.magnetic, 'arrow')
    }
  }

  dispose(): void {
    this.group.removeFromParent()
    for (const { arrow } of this.vectors) arrow.dispose()
  }
}

/** A curve drawn by the learner. */
export class Sketch {
  readonly line = new Line(3)
  private label = ''
  private end: Vector3 | null = null
  frame: Frame = 'support'

  set(points: readonly Triple[] | readonly [number, number][] | null, label: string, frame: Frame): void {
    this.label = label
    this.frame = frame
    const flat = (points ?? []).flatMap(([x, y, z]) => [x ?? 0, y ?? 0, z ?? 0])
    this.line.setPoints(pieces(flat.length ? [flat] : []))
    this.end = flat.length ? new Vector3().fromArray(flat, flat.length - 3) : null
  }

  look({ arrows }: Palette, width: number): void {
    this.line.look({ colour: arrows.sketch, width })
  }

  update(shown: boolean, labels: LabelLayer, { arrows }: Palette, toSupport: (place: Vector3) => Vector3): void {
    this.line.mesh.visible = shown && this.end !== null
    if (this.line.mesh.visible && this.label && this.end)
      labels.put(this.label, toSupport(this.end.clone()), arrows.sketch, 'sketch')
  }
}

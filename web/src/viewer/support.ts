/** The support: its mesh with markings that show how it turns, an edge where it has one, and glass seen from behind. */
import {
  BackSide,
  Box3,
  BufferAttribute,
  BufferGeometry,
  Color,
  FrontSide,
  Group,
  LatheGeometry,
  Mesh,
  MeshLambertMaterial,
  type Object3D,
  PlaneGeometry,
  Vector2,
  Vector3,
  Vector4,
} from 'three'
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js'
import { Line, pieces } from './lines'
import { mark, paintSupport, type SupportPaint } from './paint'
import { lengthWords } from './quantities'
import { edgesOf } from './rim'
import { type Scene, sameNumbers } from './scene'
import type { Palette } from './theme'

export const MOST_TOUCHES = 5

type Part = Mesh<BufferGeometry, MeshLambertMaterial>

export class SupportModel {
  /** Holds all that is fixed to the support's material. */
  readonly group = new Group()
  private readonly rim = new Line(1)
  private readonly paint: SupportPaint = newPaint()
  private readonly front = this.part(FrontSide)
  private readonly back = this.part(BackSide)
  private readonly side = this.part(FrontSide)
  private scene: Scene | null = null
  /** What its markings measure, in words. */
  note = ''

  constructor(root: Object3D) {
    this.group.add(this.rim.mesh)
    root.add(this.group)
  }

  /** What a pointer meets; null where a scene has no support. */
  get surface(): Part | null {
    return this.front.visible ? this.front : null
  }

  /** The same from its two sides, of which each is met only from where it is seen. */
  get sides(): readonly Part[] {
    return this.front.visible ? [this.front, this.back] : []
  }

  /** Take the support of a scene, unless it is the one that is there. */
  load(scenes: readonly Scene[]): void {
    const scene = scenes[0]!
    const before = this.scene
    this.scene = scene
    const sheet = endless(scene)
    if (!sheet && before && sameGround(before, scene)) return
    const { support } = scene.header
    const { support_vertices: vertices, support_normals: normals, support_triangles: triangles } = scene.columns
    const there = vertices !== undefined && normals !== undefined && triangles !== undefined
    const { flat } = support
    const edged = flat && reachesRim(scene)
    const boundless = flat && !edged
    repaint(this.paint, scene)
    const square = support.marks === 'square'
    for (const part of [this.front, this.back, this.side]) {
      part.visible = there && part !== this.side
      mark(part.material, { square, flat })
    }
    this.rim.setPoints(new Float32Array())
    if (!there) return
    const geometry = sheet ? sheetUnder(scenes) : geometryOf(scene)
    this.measure(geometry, flat, square)
    // Any plane is drawn as one that fades, so that no program is needed anew where its edge comes and goes.
    this.replace(this.front, geometry, flat)
    this.replace(this.back, geometry, true)
    this.side.visible = edged
    if (edged) this.replace(this.side, skirt(support.rim!), flat)
    if (boundless) this.paint.fade.value.copy(extentOf(geometry))
    else this.rim.setPoints(pieces(edgesOf(vertices, triangles)))
  }

  /** Markings at round distances, and what they are in words. */
  private measure(geometry: BufferGeometry, flat: boolean, square: boolean): void {
    geometry.computeBoundingBox()
    const { min, max } = geometry.boundingBox!
    const spacing = roundLength((square ? 0.07 : 0.15) * Math.max(max.x - min.x, max.y - min.y))
    this.paint.spacing.value = spacing
    const words = square ? 'squares of' : 'rings every'
    this.note = flat || square ? `${words} ${lengthWords(spacing)}` : ''
  }

  private part(side: typeof FrontSide | typeof BackSide): Part {
    const back = side === BackSide
    const material = new MeshLambertMaterial({
      side,
      transparent: back,
      depthWrite: !back,
      // Lines that lie on the surface win.
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    })
    paintSupport(material, this.paint)
    const mesh = new Mesh(new BufferGeometry(), material)
    mesh.receiveShadow = !back
    mesh.renderOrder = back ? 4 : 0
    this.group.add(mesh)
    return mesh
  }

  private replace(part: Part, geometry: BufferGeometry, clear: boolean): void {
    part.geometry.dispose()
    part.geometry = geometry
    if (part.material.transparent === clear) return
    part.material.transparent = clear
    part.material.needsUpdate = true
  }

  look(palette: Palette, widths: { rim: number }): void {
    const { support } = palette
    this.paint.base.value.set(support.base)
    this.paint.other.value.set(support.other)
    this.paint.line.value.set(support.line)
    this.paint.accent.value.set(support.mark)
    this.paint.stroke.value = widths.rim * 0.8
    this.rim.look({ colour: support.edge, width: widths.rim })
    this.back.material.opacity = support.glass
  }

  resize(width: number, height: number): void {
    this.rim.resize(width, height)
  }

  /** Leave out the underside of a plane that is seen from above: its triangles would be tried one by one, and left. */
  seenFrom(eye: Vector3): void {
    if (!this.scene?.header.support.flat) return
    this.back.visible = this.front.visible && this.group.worldToLocal(from.copy(eye)).z <= 0
  }

  /** Darken the surface where bodies touch it: places in the support's own frame, and how wide. */
  shade(index: number, x: number, y: number, z: number, radius: number): void {
    const { touches, touching } = this.paint
    touches.value[index]?.set(x, y, z, radius)
    touching.value = touches.value.reduce((most, { w }, at) => (w > 0 ? at + 1 : most), 0)
  }

  dispose(): void {
    this.group.removeFromParent()
    this.rim.dispose()
    for (const part of [this.front, this.back, this.side]) {
      part.geometry.dispose()
      part.material.dispose()
    }
  }
}

const from = new Vector3()
/** Where a plane fades that does not: so far off. */
const NOWHERE = new Vector4(0, 0, 1e30, 1e30)

/** Whether two scenes' supports look the same: to make one anew takes longer than to compare. */
function sameGround(one: Scene, other: Scene): boolean {
  const [a, b] = [one.header.support, other.header.support]
  if (a.kind !== b.kind || a.moves !== b.moves || a.rim !== b.rim || a.marks !== b.marks || a.size !== b.size)
    return false
  return sameNumbers(one.columns.support_vertices, other.columns.support_vertices)
}

function newPaint(): SupportPaint {
  return {
    base: { value: new Color() },
    other: { value: new Color() },
    line: { value: new Color() },
    accent: { value: new Color() },
    sectors: { value: 12 },
    rings: { value: 4 },
    contrast: { value: 1 },
    accented: { value: 1 },
    spacing: { value: 1 },
    stroke: { value: 1.3 },
    shade: { value: 0.6 },
    touching: { value: 0 },
    touches: { value: Array.from({ length: MOST_TOUCHES }, () => new Vector4(0, 0, 0, 0)) },
    fade: { value: NOWHERE.clone() },
  }
}

/** What stands still is marked more quietly than what moves. */
function repaint(paint: SupportPaint, { header: { support } }: Scene): void {
  paint.contrast.value = support.moves ? 1 : 0.45
  paint.accented.value = support.moves ? 1 : 0
  paint.fade.value.copy(NOWHERE)
}

function geometryOf({ columns }: Scene): BufferGeometry {
  const vertices = columns.support_vertices!
  const geometry = new BufferGeometry()
  geometry.setAttribute('position', new BufferAttribute(vertices, 3))
  geometry.setAttribute('normal', new BufferAttribute(columns.support_normals!, 3))
  const marks = columns.support_marks ?? new Float32Array((2 * vertices.length) / 3)
  geometry.setAttribute('marks', new BufferAttribute(marks, 2))
  return geometry.setIndex(new BufferAttribute(columns.support_triangles!, 1))
}

/** The side of a turntable, with the markings of its top carried over the edge. */
function skirt(rim: number): BufferGeometry {
  const deep = 0.07 * rim
  const bevel = 0.18 * deep
  const profile: [number, number][] = [
    [rim, 0],
    [rim + bevel, -bevel],
    [rim + bevel, -deep],
    [0.9 * rim, -1.25 * deep],
    [0, -1.25 * deep],
  ]
  // A lathe turns about its second axis; the support's axis is the third. One for each side, so that edges stay sharp.
  const sides = profile.slice(1).map(
    (end, i) =>
      new LatheGeometry(
        [end, profile[i]!].map(([r, z]) => new Vector2(r, z)),
        120,
      ),
  )
  const whole = mergeGeometries(sides).rotateX(Math.PI / 2)
  const turns = whole.getAttribute('uv')
  const marks = new Float32Array(2 * turns.count)
  for (let i = 0; i < turns.count; i++) {
    // The lathe counts its turns the other way, from a quarter turn on.
    marks[2 * i] = 1.25 - turns.getX(i)
    marks[2 * i + 1] = 0.9
  }
  return whole.setAttribute('marks', new BufferAttribute(marks, 2))
}

/** Of a large table with a short path only a part is shown, and not its edge. */
function reachesRim({ header: { support } }: Scene): boolean {
  return support.rim !== null && support.size > 0.999 * support.rim
}

/** A plane without an edge that does not turn: any part of it looks alike, so that one can show as much as one likes. */
function endless({ header: { support } }: Scene): boolean {
  return support.flat && support.rim === null && support.marks === 'square' && !support.moves
}

/** A rectangle of such a plane under all paths, with much room about them. */
function sheetUnder(scenes: readonly Scene[]): BufferGeometry {
  const box = new Box3()
  const place = new Vector3()
  for (const { columns, header } of scenes) {
    const { position } = columns
    for (let i = 0; i + 2 < position.length; i += 3) {
      place.fromArray(position, i).setZ(0)
      if (Number.isFinite(place.x + place.y)) box.expandByPoint(place)
    }
    box.expandByScalar(1.5 * header.body.radius)
  }
  const size = box.getSize(place)
  const pad = 0.9 * Math.max(size.x, size.y)
  const [left, right, front, rear] = [box.min.x - pad, box.max.x + pad, box.min.y - pad, box.max.y + pad]
  const sheet = new PlaneGeometry(right - left, rear - front).translate((left + right) / 2, (front + rear) / 2, 0)
  return sheet.setAttribute('marks', sheet.getAttribute('uv').clone())
}

function extentOf(geometry: BufferGeometry): Vector4 {
  geometry.computeBoundingBox()
  const { min, max } = geometry.boundingBox!
  return new Vector4((min.x + max.x) / 2, (min.y + max.y) / 2, (max.x - min.x) / 2, (max.y - min.y) / 2)
}

/** The nearest of 1, 2 and 5 times a power of ten that is not larger. */
export function roundLength(length: number): number {
  if (!(length > 0)) return 1
  const power = 10 ** Math.floor(Math.log10(length))
  const digit = length / power
  return (digit >= 5 ? 5 : digit >= 2 ? 2 : 1) * power
}

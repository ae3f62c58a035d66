/** The support: its mesh with markings that show how it turns, an edge where it has one, and glass seen from behind. */
import {
  BackSide,
  BufferAttribute,
  BufferGeometry,
  Color,
  FrontSide,
  Group,
  LatheGeometry,
  Mesh,
  MeshStandardMaterial,
  Vector2,
  Vector4,
} from 'three'
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js'
import { Line, pieces } from './lines'
import { paintSupport, type SupportPaint } from './paint'
import { edgesOf } from './rim'
import type { Scene } from './scene'
import type { Palette } from './theme'

const MOST_TOUCHES = 5

export class SupportModel {
  /** Holds all that is fixed to the support's material. */
  readonly group = new Group()
  readonly surface: Mesh<BufferGeometry, MeshStandardMaterial> | null = null
  private readonly rim = new Line(1)
  private readonly meshes: Mesh<BufferGeometry, MeshStandardMaterial>[] = []
  private readonly paint: SupportPaint

  constructor(readonly scene: Scene) {
    const { header, columns } = scene
    this.paint = newPaint(scene)
    this.group.add(this.rim.mesh)
    if (!columns.support_vertices || !columns.support_normals || !columns.support_triangles) return
    const geometry = geometryOf(scene)
    const plane = header.support.kind === 'plane'
    const boundless = plane && header.support.rim === null
    this.surface = this.add(geometry, 'front', boundless)
    this.add(geometry, 'back', boundless)
    if (plane && header.support.rim !== null) this.add(skirt(header.support.rim), 'front', false)
    if (!boundless) this.rim.setPoints(pieces(edgesOf(columns.support_vertices, columns.support_triangles)))
    else this.paint.fade.value.copy(extentOf(geometry))
  }

  private add(
    geometry: BufferGeometry,
    side: 'front' | 'back',
    clear: boolean,
  ): Mesh<BufferGeometry, MeshStandardMaterial> {
    const back = side === 'back'
    const material = new MeshStandardMaterial({
      roughness: 0.85,
      metalness: 0,
      side: back ? BackSide : FrontSide,
      transparent: back || clear,
      depthWrite: !back,
      // Lines that lie on the surface win.
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    })
    paintSupport(material, this.paint)
    const mesh = new Mesh(geometry, material)
    mesh.receiveShadow = !back
    mesh.renderOrder = back ? 4 : 0
    this.meshes.push(mesh)
    this.group.add(mesh)
    return mesh
  }

  look(palette: Palette, widths: { rim: number }): void {
    const { support } = palette
    this.paint.base.value.set(support.base)
    this.paint.other.value.set(support.other)
    this.paint.line.value.set(support.line)
    this.paint.accent.value.set(support.mark)
    this.paint.stroke.value = widths.rim * 0.8
    this.rim.look({ colour: support.edge, width: widths.rim })
    for (const mesh of this.meshes) if (mesh.material.side === BackSide) mesh.material.opacity = support.glass
  }

  resize(width: number, height: number): void {
    this.rim.resize(width, height)
  }

  /** Darken the surface where bodies touch it: places in the support's own frame, and how wide. */
  shade(index: number, x: number, y: number, z: number, radius: number): void {
    this.paint.touches.value[index]?.set(x, y, z, radius)
  }

  dispose(): void {
    this.group.removeFromParent()
    this.rim.dispose()
    for (const mesh of this.meshes) {
      mesh.geometry.dispose()
      mesh.material.dispose()
    }
  }
}

function newPaint({ header }: Scene): SupportPaint {
  const { support } = header
  return {
    base: { value: new Color() },
    other: { value: new Color() },
    line: { value: new Color() },
    accent: { value: new Color() },
    polar: { value: support.marks === 'square' ? 0 : 1 },
    sectors: { value: 12 },
    rings: { value: 4 },
    contrast: { value: support.moves ? 1 : 0.45 },
    accented: { value: support.moves ? 1 : 0 },
    spacing: { value: roundLength(0.12 * support.size) },
    stroke: { value: 1.3 },
    shade: { value: 0.6 },
    touches: { value: Array.from({ length: MOST_TOUCHES }, () => new Vector4(0, 0, 0, 0)) },
    fade: { value: new Vector4(0, 0, 0, 0) },
  }
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

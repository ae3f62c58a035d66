/** The bodies: their meshes, painted so that every turn of theirs is seen. */
import {
  BufferAttribute,
  BufferGeometry,
  Group,
  Mesh,
  MeshPhysicalMaterial,
  SphereGeometry,
  type WebGLRenderer,
} from 'three'
import { type BodyPaint, newBodyPaint, paintBody } from './paint'
import { Pin } from './pin'
import { type Scene, sameNumbers } from './scene'
import { pixelsPerPoint } from './stage'
import type { Palette } from './theme'
import { Track } from './track'

const MOST_FLASHES = 24
const FAINT = 0.35 // how much is seen of where it was

export class BodyModel {
  readonly group = new Group()
  readonly mesh: Mesh<BufferGeometry, MeshPhysicalMaterial>
  scene: Scene
  track: Track
  private readonly paint: BodyPaint = newBodyPaint()
  private readonly flashes: Mesh<BufferGeometry, MeshPhysicalMaterial>[] = []
  private readonly pin: Pin | null
  private faintly: MeshPhysicalMaterial | null = null

  constructor(
    scene: Scene,
    readonly order: number,
    poles = false,
  ) {
    this.scene = scene
    this.track = new Track(scene)
    const geometry = bodyGeometry(scene)
    measure(geometry, this.paint)
    this.paint.plain.value = scene.header.body.kind === 'charge' ? 1 : 0
    const material = new MeshPhysicalMaterial({
      roughness: 0.42,
      metalness: 0,
      clearcoat: 0.55,
      clearcoatRoughness: 0.18,
    })
    paintBody(material, this.paint)
    this.mesh = new Mesh(geometry, material)
    this.mesh.castShadow = true
    this.mesh.onBeforeRender = (renderer) => this.thin(renderer)
    this.mesh.onBeforeShadow = (renderer) => this.thin(renderer)
    this.group.add(this.mesh)
    this.pin = poles ? new Pin() : null
    if (this.pin) this.group.add(this.pin.group)
    this.pin?.group.scale.setScalar(this.radius)
  }

  /** Take another run: material and program stay, since to make these anew takes longer than all else. */
  load(scene: Scene): void {
    const before = this.scene.columns
    this.scene = scene
    this.track = new Track(scene)
    this.pin?.group.scale.setScalar(this.radius)
    this.paint.plain.value = scene.header.body.kind === 'charge' ? 1 : 0
    const { body_vertices: vertices, body_normals: normals, body_triangles: triangles } = scene.columns
    if (sameNumbers(before.body_vertices, vertices)) return
    if (vertices && normals && normals === before.body_normals && triangles === before.body_triangles) {
      const place = this.mesh.geometry.getAttribute('position') as BufferAttribute // only larger: the rest is there
      place.copyArray(vertices).needsUpdate = true
      this.mesh.geometry.computeBoundingSphere()
    } else {
      this.mesh.geometry.dispose()
      this.mesh.geometry = bodyGeometry(scene)
    }
    measure(this.mesh.geometry, this.paint)
  }

  /** Draw a picture of few pixels with fewer triangles: a processor that draws takes as long for them as for pixels. */
  private thin(renderer: WebGLRenderer): void {
    const { geometry } = this.mesh
    const { fine, coarse } = geometry.userData as { fine?: number; coarse?: number }
    if (!fine || !coarse) return
    const few = renderer.getPixelRatio() < pixelsPerPoint()
    geometry.setDrawRange(few ? fine : 0, few ? coarse : fine)
  }

  get radius(): number {
    return this.scene.header.body.radius
  }

  colour(palette: Palette): string {
    return palette.bodies[this.order % palette.bodies.length]!
  }

  look(palette: Palette): void {
    this.paint.tint.value.set(this.colour(palette))
    this.paint.pale.value.set(palette.body.light)
    this.paint.ink.value.set(palette.body.ink)
    this.paint.pole.value.set(palette.body.pole)
    this.pin?.look(palette)
  }

  seek(time: number): void {
    this.track.seek(time)
    this.track.position(this.group.position)
    this.track.orientation(this.group.quaternion)
  }

  /** Show where it was at the last flashes of a lamp, one every so many seconds; 0: no lamp. */
  flash(time: number, every: number): void {
    const begin = this.track.begin
    const last = every > 0 ? Math.floor((Math.min(time, this.track.end) - begin) / every + 1e-9) : -1
    const first = Math.max(0, last - MOST_FLASHES + 1)
    const count = last < 0 ? 0 : last - first + 1
    while (this.flashes.length < count) this.flashes.push(this.faint())
    this.flashes.forEach((mesh, i) => {
      mesh.visible = i < count
      if (!mesh.visible) return
      mesh.geometry = this.mesh.geometry
      this.track.seek(begin + (first + i) * every)
      this.track.position(mesh.position)
      this.track.orientation(mesh.quaternion)
    })
    this.track.seek(time)
  }

  private faint(): Mesh<BufferGeometry, MeshPhysicalMaterial> {
    this.faintly ??= new MeshPhysicalMaterial({ roughness: 0.6, transparent: true, opacity: FAINT, depthWrite: false })
    if (this.flashes.length === 0) paintBody(this.faintly, this.paint)
    const mesh = new Mesh(this.mesh.geometry, this.faintly)
    this.group.parent?.add(mesh)
    return mesh
  }

  dispose(): void {
    this.pin?.dispose()
    for (const mesh of this.flashes) mesh.removeFromParent()
    this.faintly?.dispose()
    this.group.removeFromParent()
    this.mesh.geometry.dispose()
    this.mesh.material.dispose()
  }
}

function bodyGeometry({ header, columns }: Scene): BufferGeometry {
  if (!columns.body_vertices || !columns.body_normals || !columns.body_triangles) {
    const ball = new SphereGeometry(header.body.radius || 0.03 * header.support.size, 48, 32).rotateX(Math.PI / 2)
    return ball.setAttribute('pattern', ball.getAttribute('normal').clone())
  }
  const geometry = new BufferGeometry()
  geometry.setAttribute('position', new BufferAttribute(columns.body_vertices.slice(), 3)) // to be written over
  geometry.setAttribute('normal', new BufferAttribute(columns.body_normals, 3))
  geometry.setAttribute('pattern', new BufferAttribute(columns.body_pattern ?? columns.body_normals, 3))
  const { body_triangles: fine, body_coarse: coarse = [] } = columns
  const index = new Uint32Array(fine.length + coarse.length)
  index.set(fine)
  index.set(coarse, fine.length)
  geometry.setDrawRange(0, fine.length)
  geometry.userData = { fine: fine.length, coarse: coarse.length }
  return geometry.setIndex(new BufferAttribute(index, 1))
}

function measure(geometry: BufferGeometry, paint: BodyPaint): void {
  geometry.computeBoundingBox()
  const place = geometry.getAttribute('position')
  let girth = 0
  for (let i = 0; i < place.count; i++) girth = Math.max(girth, Math.hypot(place.getX(i), place.getY(i)))
  const { min, max } = geometry.boundingBox!
  paint.girth.value = girth || 1
  // A disc or a pipe has no equator worth a line: its faces and its rim say how it turns.
  paint.round_.value = max.z - min.z > 0.55 * girth && roundness(geometry) ? 1 : 0
}

/** Whether normals turn smoothly from pole to pole, as on a ball or an egg and not on a disc. */
function roundness(geometry: BufferGeometry): boolean {
  const normal = geometry.getAttribute('normal')
  let between = 0
  for (let i = 0; i < normal.count; i++)
    if (Math.abs(normal.getZ(i)) > 0.2 && Math.abs(normal.getZ(i)) < 0.95) between++
  return between > 0.3 * normal.count
}

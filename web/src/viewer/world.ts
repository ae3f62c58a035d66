/** Everything that stands on the stage, put together from scenes, and moved to a time. */
import { Vector3 } from 'three'
import { Actor } from './actor'
import { type LegendRow, type Scales, scalesOf, steadyScales } from './arrows'
import type { BodyModel } from './bodies'
import type { Frame, Show, ViewerOptions } from './contract'
import { newPose, seen, viewOf } from './frames'
import { directionFor, extent, pathPlaces, placesToShow } from './framing'
import { Axes, Fields, Sketch } from './guides'
import type { LabelLayer } from './labels'
import { contactNormal } from './normals'
import type { Scene } from './scene'
import type { Stage } from './stage'
import { MOST_TOUCHES, SupportModel } from './support'
import type { Palette, Widths } from './theme'
import { fadingTime } from './trail'

const THICK = 0.0085 // radius of an arrow's shaft, of what is shown
const SMALL = 6 // CSS pixels: a body of a smaller radius is hard to see
const STRAYED = 0.1 // share of what holds the paths that may be out of the picture

export class World {
  readonly axes = new Axes()
  readonly sketch = new Sketch()
  readonly actors: Actor[] = []
  support: SupportModel | null = null
  frame: Frame = 'world'
  /** Flashes of the lamp in a second of the run; 0: none. */
  flashes = 0
  private fields: Fields | null = null
  private scales: Scales | null = null
  private duration = 0
  private held: Vector3 | null = null
  private pathFrame: Frame | null = null
  private readonly material = newPose()
  private readonly view = newPose()
  private readonly contact = new Vector3()
  private readonly normal = new Vector3()
  private readonly before = new Vector3()
  private palette!: Palette
  private widths!: Widths

  constructor(
    private readonly stage: Stage,
    private readonly options: Pick<ViewerOptions, 'from' | 'poles'> = {},
  ) {
    stage.space.add(this.axes.group, this.sketch.line.mesh)
  }

  /** Show the first body at a place of the support frame, until there is a run from there. */
  hold(place: Vector3 | null): void {
    this.held = place?.clone() ?? null
  }

  get scenes(): Scene[] {
    return this.actors.map(({ body }) => body.scene)
  }

  /** Half of what is shown, m. */
  get unit(): number {
    return 1 / this.stage.space.scale.x
  }

  setScenes(scenes: readonly Scene[], keepScale: boolean): void {
    const [first] = scenes
    this.held = null
    for (const actor of this.actors.splice(scenes.length)) actor.dispose()
    if (!first) return
    this.rescale(scenes, keepScale)
    this.support ??= new SupportModel(this.stage.root)
    this.support.load(scenes)
    if (!keepScale) this.scales = null
    scenes.forEach((scene, i) => {
      this.actors[i] ??= new Actor(scene, i, this.stage.root, this.options.poles)
      this.actors[i]!.body.load(scene)
    })
    this.fields?.dispose()
    this.fields = new Fields(first, 0.45 * this.unit)
    this.stage.root.add(this.fields.group)
    this.duration = Math.max(...scenes.map(({ header }) => header.duration))
    this.pathFrame = null
    this.look(this.palette, this.widths)
    this.resize()
  }

  /** Keep the scale of before where the new runs are about as large, so that the picture stands still. */
  private rescale(scenes: readonly Scene[], keepScale: boolean): void {
    const scale = 1 / extent(placesToShow(scenes, this.frame))
    const ratio = scale / this.stage.space.scale.x
    if (!keepScale || ratio > 4 || ratio < 0.25) this.stage.space.scale.setScalar(scale)
  }

  look(palette: Palette, widths: Widths): void {
    this.palette = palette
    this.widths = widths
    this.axes.look(palette)
    this.fields?.look(palette)
    this.sketch.look(palette, widths.sketch)
    this.support?.look(palette, widths)
    for (const actor of this.actors) actor.look(palette, widths)
  }

  resize(): void {
    const { width, height } = this.stage
    this.support?.resize(width, height)
    this.sketch.line.resize(width, height)
    for (const actor of this.actors) actor.resize(width, height)
  }

  /** Whether a good part of the paths is out of the picture. */
  get strays(): boolean {
    const places = pathPlaces(this.scenes, this.frame)
    this.stage.camera.updateMatrixWorld()
    return places.filter((place) => !this.stage.sees(place)).length > STRAYED * places.length
  }

  resetCamera(top = false): void {
    const { scenes } = this
    if (!scenes[0]) return
    const { from } = this.options
    const usual = from ? new Vector3(...from) : directionFor(scenes[0], this.frame)
    const direction = top ? new Vector3(0, -1e-4, 1) : usual
    this.stage.frame(placesToShow(scenes, this.frame), direction)
    this.stage.shineOn(this.stage.orbit.target)
  }

  /** Move everything to a time; `follow`: the camera goes with the first body. */
  update(time: number, show: Show, labels: LabelLayer, follow: boolean): void {
    const [lead] = this.actors
    if (!lead) return
    if (this.pathFrame !== this.frame) this.layPaths()
    lead.body.track.seek(time)
    lead.body.track.supportOrientation(this.material.turn)
    lead.body.track.supportPosition(this.material.place)
    this.support?.group.position.copy(this.material.place)
    this.support?.group.quaternion.copy(this.material.turn)
    viewOf(this.frame, lead.body.scene.header.to_world, this.material, this.view)
    this.before.copy(lead.body.group.position).applyMatrix4(this.stage.root.matrixWorld)
    this.stage.root.quaternion.copy(this.view.turn)
    this.stage.root.position.copy(this.view.place)
    const every = this.flashes > 0 && this.frame !== 'corotating' ? 1 / this.flashes : 0
    for (const actor of this.actors) {
      actor.body.flash(time, every)
      actor.body.seek(time)
    }
    if (this.held) lead.body.group.position.copy(this.held)
    this.stage.space.updateMatrixWorld(true)
    if (follow)
      this.stage.carry(
        this.contact.copy(lead.body.group.position).applyMatrix4(this.stage.root.matrixWorld).sub(this.before),
      )
    this.support?.seenFrom(this.stage.camera.position)
    this.decorate(time, show, labels)
  }

  private decorate(time: number, show: Show, labels: LabelLayer): void {
    this.stage.camera.updateMatrixWorld()
    labels.begin((place) => this.stage.project(place))
    const thick = THICK * this.unit * (this.widths.trail / 4)
    this.actors.forEach((actor, i) => {
      const { body } = actor
      actor.reach(time, fadingTime(this.duration), show)
      if (actor.guided && show.guidingCentre && body.track.vector('guiding_centre', this.contact)) {
        labels.put('', this.contact, this.palette.arrows.guide, 'guide')
      }
      body.track.contact(this.contact)
      if (show.frictionCone) contactNormal(body, this.scenes[0]!, this.contact, this.normal)
      actor.arrows.ride(this.frame === 'corotating' ? time : null)
      actor.arrows.update(show, labels, this.palette, thick, this.normal)
      this.shade(i, body)
      this.name(actor, labels)
    })
    for (let i = this.actors.length; i < MOST_TOUCHES; i++) this.support?.shade(i, 0, 0, 0, 0)
    const toSupport = (place: Vector3) => this.toSupport(place)
    if (this.options.poles && this.actors[0]) this.compass(this.actors[0].body, thick, labels)
    else this.axes.update(show.axes, 0.35 * this.unit, 0.7 * thick, labels, toSupport)
    this.fields?.update(thick, labels, this.palette)
    const lies = (this.sketch.frame === 'corotating') === (this.frame === 'corotating')
    this.placeSketch()
    this.sketch.update(lies, labels, this.palette, (place) => (this.frame === 'corotating' ? toSupport(place) : place))
    labels.end()
  }

  /** East and north on the floor, from where the first body begins. */
  private compass(body: BodyModel, thick: number, labels: LabelLayer): void {
    const { contact, position } = body.scene.columns
    const origin = this.axes.group.position.fromArray(contact ?? position)
    if (!contact) origin.z -= body.radius
    const toSupport = (place: Vector3) => place.add(origin)
    this.axes.update(true, 2.6 * body.radius, 0.7 * thick, labels, toSupport, ['E', 'N'])
  }

  /** Several bodies are named; one that is too small to be seen gets a ring round it. */
  private name({ body }: Actor, labels: LabelLayer): void {
    const colour = body.colour(this.palette)
    const { position } = body.group
    if (body.radius < SMALL * this.stage.metresPerPixel(position)) labels.put('', position, colour, 'spot')
    if (this.actors.length > 1) labels.put(body.scene.header.body.label, position, colour, 'body')
  }

  /** A learner's curve lies in the support frame, or on the support's material. */
  private placeSketch(): void {
    const parent = this.frame === 'corotating' ? this.stage.space : this.stage.root
    if (this.sketch.line.mesh.parent !== parent) parent.add(this.sketch.line.mesh)
  }

  private shade(index: number, body: BodyModel): void {
    if (!this.support) return
    body.track.contact(this.contact)
    const high = body.track.phase === 2 ? 0 : 0.55 * body.radius
    const place = this.contact
      .sub(this.material.place)
      .applyQuaternion(this.view.turn.clone().copy(this.material.turn).conjugate())
    this.support.shade(index, place.x, place.y, place.z, high)
  }

  /** Paths lie on the support's material where that is the frame shown, and else stand still in the support frame. */
  private layPaths(): void {
    const riding = this.frame === 'corotating'
    const known = this.pathFrame !== null && (this.pathFrame === 'corotating') === riding
    if (this.pathFrame !== null && !known) this.scales = null // another observer sees other speeds
    this.pathFrame = this.frame
    if (known) return
    this.scales = steadyScales(this.scales, scalesOf(this.scenes, 0.5 * this.unit, riding))
    for (const { arrows } of this.actors) arrows.load(this.scales, this.unit)
    for (const actor of this.actors) actor.layPaths(this.frame, riding ? this.stage.space : this.stage.root)
  }

  /** From the shown frame, m, to the support frame. */
  toSupport(place: Vector3): Vector3 {
    return place.sub(this.view.place).applyQuaternion(this.view.turn.clone().conjugate())
  }

  /** From the support frame, m, to the shown frame. */
  toShown(place: Vector3): Vector3 {
    return seen(this.view, place)
  }

  /** The first body, in the shown frame, m. */
  shownPlace(index: number, out: Vector3): Vector3 {
    const actor = this.actors[index]
    return actor ? seen(this.view, out.copy(actor.body.group.position)) : out.set(0, 0, 0)
  }

  legend(show: Show): LegendRow[] {
    return this.actors[0]?.arrows.legend(show, this.palette) ?? []
  }

  dispose(): void {
    for (const actor of this.actors) actor.dispose()
    this.fields?.dispose()
    this.support?.dispose()
    this.axes.dispose()
    this.sketch.line.dispose()
  }
}

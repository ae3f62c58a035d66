/** One body with all that belongs to it: its path, its guiding centre's path, its arrows. Kept from run to run. */
import type { Object3D } from 'three'
import { BodyArrows } from './arrows'
import { BodyModel } from './bodies'
import type { Frame, Show } from './contract'
import { Line } from './lines'
import type { Scene } from './scene'
import type { Palette } from './theme'
import { pathPoints } from './trail'

const LEAST = 0.34 // of an old path's colour that stays
const THIN = 0.5 // width of the path that is to come, as a share
const ALL = 1e29 // s: later than any sample

export class Actor {
  readonly body: BodyModel
  readonly arrows: BodyArrows
  private readonly trail = new Line(3)
  private readonly ahead = new Line(2)
  private readonly guide = new Line(2)

  constructor(scene: Scene, order: number, root: Object3D, poles = false) {
    this.body = new BodyModel(scene, order, poles)
    this.arrows = new BodyArrows(this.body)
    root.add(this.body.group, this.arrows.group, this.ahead.mesh, this.trail.mesh, this.guide.mesh)
  }

  /** Whether the run has a guiding centre. */
  get guided(): boolean {
    return this.body.scene.columns.guiding_centre !== undefined
  }

  layPaths(frame: Frame, parent: Object3D): void {
    this.trail.setPoints(pathPoints(this.body.scene, frame))
    this.ahead.sharePoints(this.trail)
    this.guide.setPoints(this.guided ? pathPoints(this.body.scene, frame, 'guiding_centre') : new Float32Array())
    parent.add(this.ahead.mesh, this.trail.mesh, this.guide.mesh)
  }

  look(palette: Palette, widths: { trail: number; guide: number }): void {
    this.body.look(palette)
    this.arrows.look(palette)
    const colours = { colour: this.body.colour(palette), faded: palette.support.base }
    this.trail.look({ ...colours, width: widths.trail })
    this.ahead.look({ ...colours, width: THIN * widths.trail })
    this.guide.look({ colour: palette.arrows.guide, faded: palette.support.base, width: widths.guide })
  }

  resize(width: number, height: number): void {
    this.trail.resize(width, height)
    this.ahead.resize(width, height)
    this.guide.resize(width, height)
  }

  /** Show the paths up to a time. */
  reach(time: number, fading: number, show: Show): void {
    this.trail.mesh.visible = show.trail
    this.ahead.mesh.visible = show.trail && show.ahead
    this.guide.mesh.visible = show.guidingCentre && this.guided
    this.trail.reach(time, fading, LEAST)
    this.ahead.reach(ALL, fading, LEAST, time)
    this.guide.reach(time, fading, LEAST)
  }

  dispose(): void {
    this.body.dispose()
    this.arrows.dispose()
    this.trail.dispose()
    this.ahead.dispose()
    this.guide.dispose()
  }
}

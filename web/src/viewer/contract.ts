/** What the viewer offers to the pages that hold it. */
import type { Scene, Triple } from './scene'

export type Frame = 'support' | 'world' | 'corotating'
export type Tool = 'orbit' | 'drag' | 'velocity' | 'nudge' | 'draw'
export type Theme = 'light' | 'dark' | 'auto'

export interface Show {
  velocity: boolean
  contactForce: boolean
  angularVelocity: boolean
  gravity: boolean
  frictionCone: boolean
  guidingCentre: boolean
  trail: boolean
  /** The rest of the path, that is still to come, thin and pale: for a film that stands still. */
  ahead: boolean
  axes: boolean
}

export interface ViewerOptions {
  theme?: Theme
  /** The viewer's own bar: play, scrub, frame, arrows. Default yes. */
  controls?: boolean
  /** Large type and thick lines, for the back row. */
  projector?: boolean
  frame?: Frame
  show?: Partial<Show>
  /** From where the camera looks at first, of the shown frame; absent: as it suits the scene. */
  from?: Triple
  /** For who watches the poles: a pin through those of each body, and a compass on the floor. */
  poles?: boolean
}

export interface ViewerEvents {
  time: { time: number }
  play: { time: number }
  pause: { time: number }
  frame: { frame: Frame }
  show: { show: Show }
  /** A place on the support, in its frame: where the first body is dragged to. */
  dragstart: Place
  drag: Place
  /** Let go; `velocity`: thrown so, m/s, along the support. */
  dragend: Place & { velocity: Triple | null }
  /** A velocity drawn as an arrow along the support, in m/s. */
  arrow: Drawn
  /** The same while it runs: what is to be added to the velocity at this time. */
  nudge: Drawn & { time: number }
  /** A curve drawn on the support; its points are those of the support's material where the frame is corotating. */
  sketch: { points: Triple[]; frame: Frame }
}

/** Of the body, in the support frame, m. */
export interface Place {
  x: number
  y: number
  z: number
  /** Where it touches there. */
  contact: Triple
}

export interface Drawn {
  vx: number
  vy: number
  vz: number
  done: boolean
}

export interface SceneOptions {
  keepTime?: boolean
  keepCamera?: boolean
  /** Nothing changes any more for now: to be drawn in full at once, also where each pixel is dear. */
  rests?: boolean
}

export interface Viewer {
  /** Several scenes share the support of the first; each has its own body, in the order of `BODY_COLOURS`. */
  setScenes(scenes: readonly Scene[], options?: SceneOptions): void
  play(): void
  pause(): void
  seek(time: number): void
  /** One sample on, or back. */
  step(by: number): void
  speed: number
  loop: boolean
  /** A stroboscope: so many flashes in a second of the run, of which each leaves a faint picture of the body; 0: none. */
  flashes: number
  /** Begin at a speed at which the runs can be watched, again and again where they are short; returns that speed. */
  suit(): number
  readonly time: number
  readonly duration: number
  readonly playing: boolean
  frame: Frame
  /** Whether the run is heard while it plays: rolling, slipping, landings. */
  sound: boolean
  /** Live: `viewer.show.velocity = true` and `viewer.show = { velocity: true }` do the same. */
  get show(): Show
  set show(part: Partial<Show>)
  tool: Tool
  /** Whether the first body may be taken hold of while the tool turns the view: beside it, the view turns. */
  grabs: boolean
  get theme(): 'light' | 'dark'
  set theme(theme: Theme)
  projector: boolean
  /** The camera goes with the first body. */
  follow: boolean
  resetCamera(): void
  topView(): void
  /** A curve drawn by the learner; null takes it away. */
  setSketch(points: readonly Triple[] | readonly [number, number][] | null, label?: string, frame?: Frame): void
  /** Subscribe; returns how to unsubscribe. */
  on<Name extends keyof ViewerEvents>(name: Name, listener: (event: ViewerEvents[Name]) => void): () => void
  snapshot(): Promise<Blob>
  dispose(): void
}

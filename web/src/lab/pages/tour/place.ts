/** What a step of the tour is given to build in, and what it gives back. */
import type { Scene } from '../../../viewer/scene'
import type { App } from '../../app'
import type { Scenario } from '../../scenario'
import type { Numbers } from '../parts/numbers'

export interface Place {
  readonly app: App
  /** For the stage or the stages. */
  readonly stage: HTMLElement
  /** Under the stage: the one thing to do. */
  readonly controls: HTMLElement
  readonly numbers: Numbers
  /** The scene's own formula, with the current numbers put in; null takes it away. */
  worked(scene: Scene | null): void
  /** Beneath the step's text: what is said once something has been done. */
  readonly remark: HTMLElement
  /** What "make it yours" opens on the bench. */
  offer(scenario: Scenario): void
}

/** Build a step; the returned function takes it down. */
export type StepMount = (place: Place) => () => void

/** A viewer in its frame, told of theme and projector, with a place for what went wrong. */

import { say } from '../../../viewer/elements'
import { printed } from '../../../viewer/printing'
import type { Scene, Triple } from '../../../viewer/scene'
import { createViewer, type Viewer, type ViewerOptions } from '../../../viewer/viewer'
import { ApiError, isAbort } from '../../api'
import type { App } from '../../app'
import { cleanup, h, plainly } from '../../dom'
import { createRunner } from '../../runner'
import type { Scenario } from '../../scenario'

export interface Stage {
  readonly element: HTMLElement
  readonly viewer: Viewer
  /** Say what is wrong over the stage; null takes it away. */
  problem(error: unknown): void
  dispose(): void
}

export interface StageOptions extends Pick<ViewerOptions, 'from' | 'poles'> {
  /** What is seen, for who does not see it. */
  label: string
  /** The viewer's own bar of controls; default yes. */
  controls?: boolean
  kind?: 'large' | 'half'
}

/** From where a pole is seen on whichever upper side it lies, with north upwards. */
export const FROM_ABOVE: Triple = [0.2, -0.75, 1]

export function createStage(app: App, { label, controls = true, kind = 'large', ...seen }: StageOptions): Stage {
  const undo = cleanup()
  const view = h('div', { class: 'theatre-view' })
  const message = h('p', { class: 'theatre-problem', role: 'alert', hidden: true })
  const element = h('div', { class: `theatre theatre-${kind}`, role: 'group', 'aria-label': label }, view, message)
  const viewer = createViewer(view, { theme: app.appearance, controls, projector: app.settings.projector, ...seen })
  undo.add(printed(view, viewer), () => viewer.dispose())
  undo.add(
    app.watchSettings((settings) => {
      viewer.theme = app.appearance
      viewer.projector = settings.projector
    }),
  )
  return {
    element,
    viewer,
    problem(error) {
      if (error !== null && isAbort(error)) return
      message.hidden = error === null
      say(message, error === null ? '' : told(error))
    },
    dispose: () => undo.run(),
  }
}

export function told(error: unknown): string {
  if (error instanceof ApiError || error instanceof Error) return plainly(error.message)
  return 'Something went wrong here.'
}

export interface Live {
  ask(scenario: Scenario): void
  stop(): void
}

/** Simulate whatever was asked for last, and show it on the stage as soon as it is there. */
export function simulating(app: App, stage: Stage, shown: (scene: Scene, scenario: Scenario) => void): Live {
  return createRunner<Scenario, Scene>({
    run: async (scenario, signal) => (await app.api.simulate(scenario, { lane: null, signal })).scene,
    done(scene, scenario) {
      stage.problem(null)
      shown(scene, scenario)
    },
    failed: (error) => stage.problem(error),
  })
}

/** Start a stage's play, unless the visitor asks for less motion. */
export function playUnlessCalm(app: App, viewer: Viewer): void {
  if (!app.settings.reducedMotion) viewer.play()
}

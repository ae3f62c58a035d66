/** Every change is computed anew: quickly at first, in full and with the card when the numbers rest. */
import type { Scene } from '../../viewer/scene'
import { isAbort } from '../api'
import type { App } from '../app'
import { createRunner } from '../runner'
import type { Scenario } from '../scenario'
import type { CardState } from './card'

export interface Listener {
  /** `again`: of the scenario that is shown already, in full. */
  scene(scene: Scene, milliseconds: number, again: boolean): void
  /** The numbers rest. */
  settled(scene: Scene): void
  failed(error: unknown): void
  busy(is: boolean): void
  card(state: CardState): void
}

export interface Computing {
  ask(scenario: Scenario): void
  stop(): void
}

/** What is enough for the eye, which follows the path and not its points, and sees no billionth of it. */
const QUICK = { samples: 1500, tolerance: 1e-9 }
const REST = 600

/** Is there more to a scenario than what was computed quickly? */
function coarse({ columns, header }: Scene): boolean {
  return columns.time.length >= QUICK.samples || header.tolerance >= QUICK.tolerance
}

export function createComputing(app: App, listener: Listener): Computing {
  let rest: ReturnType<typeof setTimeout> | undefined
  let shown: { scene: Scene; scenario: Scenario; quick: boolean } | undefined

  const runner = createRunner<{ scenario: Scenario; quick: boolean }, { scene: Scene; milliseconds: number }>({
    run: ({ scenario, quick }, signal) => app.api.simulate(scenario, { signal, lane: null, ...(quick && QUICK) }),
    done({ scene, milliseconds }, { scenario, quick }) {
      const again = shown?.scenario === scenario
      shown = { scene, scenario, quick }
      listener.scene(scene, milliseconds, again)
    },
    failed: (error) => {
      shown = undefined
      clearTimeout(rest)
      listener.card({ state: 'none', message: 'There is a card when the scenario can be run.' })
      listener.failed(error)
    },
    state: (busy) => listener.busy(busy),
  })

  async function whenAtRest(scenario: Scenario): Promise<void> {
    if (!shown || shown.scenario !== scenario) return
    listener.settled(shown.scene)
    if (shown.quick && coarse(shown.scene)) runner.ask({ scenario, quick: false })
    if (!scenario.support) {
      listener.card({ state: 'none', message: 'A path that is rolled without forces has no card.' })
      return
    }
    listener.card({ state: 'working' })
    try {
      listener.card({ state: 'there', card: await app.api.card(scenario) })
    } catch (error) {
      if (!isAbort(error))
        listener.card({ state: 'failed', message: error instanceof Error ? error.message : String(error) })
    }
  }

  function later(scenario: Scenario): void {
    clearTimeout(rest)
    rest = setTimeout(() => {
      // A slow run may still be on its way: its card waits for it.
      if (shown?.scenario === scenario) void whenAtRest(scenario)
      else later(scenario)
    }, REST)
  }

  return {
    ask(scenario) {
      app.api.cancel('card')
      listener.card({ state: 'waiting' })
      runner.ask({ scenario, quick: true })
      later(scenario)
    },
    stop() {
      clearTimeout(rest)
      runner.stop()
      app.api.cancel('card')
    },
  }
}

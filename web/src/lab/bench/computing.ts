/** Every change is computed anew: quickly at first, in full and with the card when the numbers rest. */
import type { Scene } from '../../viewer/scene'
import { isAbort } from '../api'
import type { App } from '../app'
import { createRunner } from '../runner'
import type { Scenario } from '../scenario'
import type { Change } from '../store'
import type { CardState } from './card'

/** How a scene stands to what was shown before it. */
export interface Since {
  /** Of another scenario that was opened: nothing of the view is kept. */
  fresh: boolean
  /** The motion begins anew. */
  restart: boolean
  /** Of the scenario that is shown already, in full. */
  again: boolean
}

export interface Listener {
  /** `curves`: the scene has them. */
  scene(scene: Scene, milliseconds: number, since: Since, curves: boolean): void
  /** The numbers rest. */
  settled(scene: Scene): void
  failed(error: unknown): void
  busy(is: boolean): void
  card(state: CardState): void
  /** Are curves looked at? Others can wait until the numbers rest. */
  readonly curves: boolean
}

export interface Computing {
  /** `change`: what made it so; absent where it was only opened. */
  ask(scenario: Scenario, change?: Change): void
  stop(): void
}

/** What is enough for the eye, which sees no billionth of a path, and while a hand moves no more points of it than these. */
const QUICK = { tolerance: 1e-9 }
const MOVING = { ...QUICK, samples: 1000 }
const REST = 600

/** How often a scenario was opened, and a motion begun anew: a scene that comes late tells of its own, not of the newest. */
interface Counts {
  opened: number
  restarted: number
}

interface Asked {
  scenario: Scenario
  counts: Counts
  /** What is shown and changes under a hand, or rests now; absent where another is opened, with one answer for all. */
  like?: Scene | undefined
  /** How little is enough for now; absent: all there is. */
  enough?: { tolerance: number; samples?: number; curves?: boolean }
}

/** Is there more to a scenario than what was computed of it? */
function coarse({ columns, header }: Scene, { enough }: Asked): boolean {
  if (!enough) return false
  const { tolerance, samples = Number.POSITIVE_INFINITY, curves = true } = enough
  return header.tolerance >= tolerance || columns.time.length >= samples || !curves
}

export function createComputing(app: Pick<App, 'api'>, listener: Listener): Computing {
  let rest: ReturnType<typeof setTimeout> | undefined
  let shown: { scene: Scene; asked: Asked } | undefined
  let counts: Counts = { opened: 1, restarted: 0 }
  let last: Counts = { opened: 0, restarted: 0 }

  const runner = createRunner<Asked, { scene: Scene; milliseconds: number }>({
    run: ({ scenario, like, enough }, signal) => app.api.simulate(scenario, { signal, lane: null, like, ...enough }),
    done({ scene, milliseconds }, asked) {
      const since = {
        fresh: last.opened !== asked.counts.opened,
        restart: last.restarted !== asked.counts.restarted,
        again: shown?.asked.scenario === asked.scenario,
      }
      last = asked.counts
      shown = { scene, asked }
      listener.scene(scene, milliseconds, since, asked.enough?.curves ?? true)
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
    if (shown?.asked.scenario !== scenario) return
    listener.settled(shown.scene)
    if (coarse(shown.scene, shown.asked)) runner.ask({ scenario, counts: shown.asked.counts, like: shown.scene })
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
      if (shown?.asked.scenario === scenario) void whenAtRest(scenario)
      else later(scenario)
    }, REST)
  }

  return {
    ask(scenario, change) {
      app.api.cancel('card')
      app.api.cancel('possible')
      listener.card({ state: 'waiting' })
      counts = {
        opened: counts.opened + Number(change?.opens ?? false),
        restarted: counts.restarted + Number(change?.restarts ?? false),
      }
      if (change?.gesture === undefined) runner.ask({ scenario, counts, enough: QUICK })
      else runner.ask({ scenario, counts, enough: { ...MOVING, curves: listener.curves }, like: shown?.scene })
      later(scenario)
    },
    stop() {
      clearTimeout(rest)
      runner.stop()
      app.api.cancel('card')
    },
  }
}

/** Two balls, the same quarter turns in two orders, side by side; and by how much their ends differ. */
import { say } from '../../../viewer/elements'
import type { Scene } from '../../../viewer/scene'
import type { App } from '../../app'
import { cleanup, h } from '../../dom'
import { button } from '../parts/controls'
import { createStage, FROM_ABOVE, type Stage } from '../parts/stage'
import { createTransport } from '../parts/transport'
import { createPoleMap, type PoleMap } from './pole'
import { poleWhile, type Rolled, roll, rolledOf } from './rolling'
import { between, inWords, piecesOf, type Turn } from './turns'

export interface Outcome {
  first: Rolled
  second: Rolled
  /** What leads from the end of the first to the end of the second. */
  difference: Rolled
}

export interface Orders {
  readonly stages: HTMLElement
  readonly controls: HTMLElement
  set(first: readonly Turn[], second: readonly Turn[]): Promise<void>
  dispose(): void
}

interface Side {
  stage: Stage
  heading: HTMLElement
  pole: PoleMap
  scene: Scene | null
}

function createSide(app: App, label: string): Side & { element: HTMLElement } {
  const stage = createStage(app, { label, controls: false, kind: 'half', poles: true, from: FROM_ABOVE })
  const heading = h('h2', { class: 'side-heading' }, label)
  const pole = createPoleMap()
  const element = h('section', { class: 'side' }, heading, stage.element, pole.element)
  return { stage, heading, pole, scene: null, element }
}

/** `done` is told the outcome each time both balls have arrived. */
export function createOrders(app: App, done: (outcome: Outcome) => void): Orders {
  const undo = cleanup()
  const sides = [createSide(app, 'First order'), createSide(app, 'Second order')] as const
  const [first, second] = sides
  const controller = new AbortController()
  const transport = createTransport(first.stage.viewer, [second.stage.viewer])
  let outcome: Outcome | null = null
  let wanted = false // somebody has asked for the balls to roll before it was known how
  undo.add(() => transport.dispose())
  undo.add(() => controller.abort())

  for (const side of sides) {
    undo.add(() => side.stage.dispose())
    undo.add(
      side.stage.viewer.on('time', () => {
        if (side.scene) side.pole.set(poleWhile(side.scene, side.stage.viewer.time))
        if (outcome && arrived()) done(outcome)
      }),
    )
  }

  function arrived(): boolean {
    return sides.every(({ stage: { viewer } }) => viewer.duration > 0 && viewer.time >= viewer.duration - 1e-6)
  }

  function play(): void {
    wanted = outcome === null
    if (wanted) return // the ways are still being computed
    const { viewer } = first.stage
    viewer.seek(app.settings.reducedMotion ? viewer.duration : 0)
    if (!app.settings.reducedMotion) viewer.play()
    announce()
  }

  function announce(): void {
    if (!outcome) return
    const ends = [outcome.first, outcome.second].map(({ north_pole }) => north_pole)
    app.announce(`Both balls end at the same place. The poles point ${ends.map(said).join(' and ')}.`)
  }

  async function set(one: readonly Turn[], other: readonly Turn[]): Promise<void> {
    outcome = null
    wanted = false
    const ways = [piecesOf(one), piecesOf(other), piecesOf(between(one, other))]
    say(first.heading, sentence(inWords(one)))
    say(second.heading, sentence(inWords(other)))
    try {
      const scenes = await Promise.all(ways.map((pieces) => roll(app, pieces, { signal: controller.signal })))
      const [a, b, c] = scenes as [Scene, Scene, Scene]
      outcome = { first: rolledOf(a), second: rolledOf(b), difference: rolledOf(c) }
      show(first, a)
      show(second, b)
      transport.refresh()
      if (wanted) play()
    } catch (error) {
      if (!controller.signal.aborted) first.stage.problem(error)
    }
  }

  function show(side: Side, scene: Scene): void {
    side.stage.problem(null)
    side.scene = scene
    side.stage.viewer.setScenes([scene])
    side.stage.viewer.loop = false
    side.stage.viewer.seek(0)
    side.pole.set(poleWhile(scene, 0))
  }

  return {
    stages: h('div', { class: 'sides' }, first.element, second.element, transport.element),
    controls: h('div', { class: 'buttons' }, button('Roll both', play, 'primary', 'roll-both')),
    set,
    dispose: () => undo.run(),
  }
}

function said(direction: readonly [number, number, number]): string {
  const [x, y, z] = direction
  if (Math.abs(z) > 0.9) return z > 0 ? 'up' : 'down'
  return Math.abs(x) > Math.abs(y) ? (x > 0 ? 'east' : 'west') : y > 0 ? 'north' : 'south'
}

function sentence(words: string): string {
  return words.charAt(0).toUpperCase() + words.slice(1)
}

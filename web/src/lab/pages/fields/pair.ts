/** A ball on its table and a charge in its fields, moving in step: one clock, two stages. */
import type { Scene } from '../../../viewer/scene'
import type { App } from '../../app'
import { cleanup, h } from '../../dom'
import { createRunner } from '../../runner'
import type { Scenario } from '../../scenario'
import { createStage, playUnlessCalm } from '../parts/stage'
import { createTransport } from '../parts/transport'

export interface Both {
  ball: Scene
  charge: Scene
}

export interface Pair {
  readonly element: HTMLElement
  ask(scenario: Scenario): void
  readonly time: number
  dispose(): void
}

export function createPair(app: App, shown: (both: Both) => void, ticked: (time: number) => void = () => {}): Pair {
  const undo = cleanup()
  const table = createStage(app, { label: 'The ball on its turning, leaning table', controls: false, kind: 'half' })
  const fields = createStage(app, { label: 'The charge in crossed fields', controls: false, kind: 'half' })
  const transport = createTransport(table.viewer, [fields.viewer])
  table.viewer.loop = true
  undo.add(
    () => table.dispose(),
    () => fields.dispose(),
    () => transport.dispose(),
  )
  let first = true

  const live = createRunner<Scenario, Both>({
    async run(scenario, signal) {
      const options = { lane: null, signal }
      const [ball, charge] = await Promise.all([
        app.api.simulate(scenario, { ...options, curves: false }),
        app.api.twin(scenario, options),
      ])
      return { ball: ball.scene, charge: charge.scene }
    },
    done(both) {
      table.problem(null)
      const keep = { keepTime: !first, keepCamera: !first }
      table.viewer.setScenes([both.ball], keep)
      fields.viewer.setScenes([overTheSameDisc(both)], keep)
      transport.refresh()
      if (first) playUnlessCalm(app, table.viewer)
      first = false
      shown(both)
    },
    failed: (error) => table.problem(error),
  })
  undo.add(() => live.stop())
  undo.add(table.viewer.on('time', () => ticked(table.viewer.time)))
  return {
    element: h(
      'div',
      { class: 'sides' },
      h('section', { class: 'side' }, h('h2', { class: 'side-heading' }, 'Ball on a leaning turntable'), table.element),
      h('section', { class: 'side' }, h('h2', { class: 'side-heading' }, 'Charge in crossed fields'), fields.element),
      transport.element,
    ),
    ask: (scenario) => live.ask(scenario),
    get time() {
      return table.viewer.time
    },
    dispose: () => undo.run(),
  }
}

/** The charge is drawn over the ball's own disc, at rest, so that both are seen from the same place and distance. */
function overTheSameDisc({ ball, charge }: Both): Scene {
  const { support_vertices, support_normals, support_triangles, support_marks } = ball.columns
  if (!support_vertices || !support_normals || !support_triangles || !support_marks) return charge
  const support = { ...ball.header.support, moves: false, name: 'Plane in crossed fields' }
  return {
    header: { ...charge.header, support },
    columns: { ...charge.columns, support_vertices, support_normals, support_triangles, support_marks },
  }
}

/** Step 4: a level turntable. The circle's rate is two sevenths of the table's. */

import type { Scenario } from '../../scenario'
import { withValue } from '../../scenario'
import { choice, slider } from '../parts/controls'
import { finding } from '../parts/measure'
import { rowOf } from '../parts/numbers'
import { LEVEL } from '../parts/scenarios'
import { createStage, playUnlessCalm, simulating } from '../parts/stage'
import type { StepMount } from './place'

/** How far out a ball may be put on a table of 50 cm, m. */
const EDGE = 0.48

const BALLS = [
  ['solid-sphere', 'Solid ball'],
  ['hollow-sphere', 'Hollow ball'],
] as const

export const mountTurntable: StepMount = ({ app, stage: host, controls, numbers, worked, offer }) => {
  const stage = createStage(app, { label: 'A ball on a turning table' })
  host.append(stage.element)
  stage.viewer.loop = true
  let scenario: Scenario = LEVEL
  let first = true

  const live = simulating(app, stage, (scene, asked) => {
    stage.viewer.setScenes([scene], { keepTime: !first, keepCamera: !first })
    if (first) playUnlessCalm(app, stage.viewer)
    first = false
    const share = rowOf(finding(scene, '\\kappa/\\omega'))
    numbers.set([rowOf(finding(scene, '\\kappa')), share && { ...share, ...fraction(asked) }])
    worked(scene)
  })

  const rate = slider({
    label: 'Rate of the table',
    min: 10,
    max: 78,
    step: 0.1,
    value: 33.3,
    words: (rpm) => `${rpm.toFixed(1)} rpm`,
    change: (rpm) => change('support.motion.rate', `${rpm} rpm`),
    testid: 'table-rate',
  })
  const ball = choice('Ball', BALLS, 'solid-sphere', (kind) => change('body.kind', kind))
  controls.append(rate.element, ball.element)

  function change(path: string, value: string | string[]): void {
    scenario = withValue(scenario, path, value)
    offer(scenario)
    live.ask(scenario)
  }

  stage.viewer.tool = 'drag'
  const off = stage.viewer.on('drag', ({ x, y }) => {
    // Not over the edge: a ball that starts there leaves at once.
    const inside = Math.min(1, EDGE / Math.hypot(x, y))
    change('start.position', [metres(x * inside), metres(y * inside)])
  })
  offer(scenario)
  live.ask(scenario)
  return () => {
    off()
    live.stop()
    stage.dispose()
  }
}

function fraction(scenario: Scenario): { predicted: string } {
  return { predicted: scenario.body.kind === 'hollow-sphere' ? '2/5 = 0.4000' : '2/7 = 0.2857' }
}

export function metres(length: number): string {
  return `${Number((length * 100).toFixed(2))} cm`
}

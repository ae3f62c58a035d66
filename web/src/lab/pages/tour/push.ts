/** Step 3: a level push, at a height that can be chosen. */
import { say } from '../../../viewer/elements'
import { h } from '../../dom'
import { slider } from '../parts/controls'
import { column, finding, vectorAt } from '../parts/measure'
import { rowOf } from '../parts/numbers'
import { pushed, shareOf } from '../parts/scenarios'
import { createStage, playUnlessCalm, simulating } from '../parts/stage'
import type { StepMount } from './place'
import { createPushDiagram } from './push-diagram'

/** Of the force, N. */
const PUSH = 0.1

export const mountPush: StepMount = ({ app, stage: host, controls, numbers, worked, remark, offer }) => {
  const stage = createStage(app, { label: 'A ball that is pushed along a level table' })
  host.append(stage.element)
  stage.viewer.loop = true
  let first = true

  const live = simulating(app, stage, (scene, asked) => {
    stage.viewer.setScenes([scene], { keepTime: !first, keepCamera: !first })
    stage.viewer.show = { ...stage.viewer.show, velocity: true }
    if (first) playUnlessCalm(app, stage.viewer)
    first = false
    const sideways = vectorAt(column(scene, 'contact_force'), 0)[0]
    const reaction = rowOf(finding(scene, 'R_\\parallel'), 1000, 'mN')
    const gained = rowOf(finding(scene, '|\\varphi|'))
    numbers.set([
      reaction && { ...reaction, name: 'reaction of the table', symbol: 'R_x' },
      gained && { ...gained, symbol: '\\dot V_x' },
    ])
    diagram.set(shareOf(asked), sideways / PUSH)
    worked(scene)
    say(remark, saying(sideways))
  })

  const height = slider({
    label: 'Height of the push above the centre',
    min: 0,
    max: 1,
    step: 0.05,
    value: 0,
    words: (share) => `${share.toFixed(2)} a`,
    change: ask,
    testid: 'push-height',
  })
  const diagram = createPushDiagram()
  const scale = h(
    'p',
    { class: 'push-scale' },
    'Magnified: F and Rₓ to one scale. Weight and normal force, 5 N, are fifty times as long.',
  )
  controls.append(height.element, h('figure', { class: 'push-figure' }, diagram.element, scale))

  function ask(share: number): void {
    const scenario = pushed(share)
    offer(scenario)
    live.ask(scenario)
  }
  ask(0)
  return () => {
    live.stop()
    stage.dispose()
  }
}

/** Which way the table pushes, and what that means. The smallest step of the slider moves it by 3.6 mN. */
function saying(reaction: number): string {
  if (Math.abs(reaction) < 1e-4) return 'Neither: at 2/5 of the radius above the centre the ball would roll on ice.'
  if (reaction < 0) return 'The table pulls the ball back. Higher!'
  return 'The table pushes the ball forward. Lower!'
}

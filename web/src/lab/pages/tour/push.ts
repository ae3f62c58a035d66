/** Step 3: a level push, at a height that can be chosen. */
import { slider } from '../parts/controls'
import { column, finding, vectorAt } from '../parts/measure'
import { rowOf } from '../parts/numbers'
import { pushed } from '../parts/scenarios'
import { createStage, playUnlessCalm, simulating } from '../parts/stage'
import type { StepMount } from './place'

export const mountPush: StepMount = ({ app, stage: host, controls, numbers, remark, offer }) => {
  const stage = createStage(app, { label: 'A ball that is pushed along a level table' })
  host.append(stage.element)
  let first = true

  const live = simulating(app, stage, (scene) => {
    stage.viewer.setScenes([scene], { keepTime: !first, keepCamera: !first })
    stage.viewer.show = { ...stage.viewer.show, contactForce: true, velocity: true }
    if (first) playUnlessCalm(app, stage.viewer)
    first = false
    const reaction = finding(scene, 'R_x')
    const gained = finding(scene, '\\dot V_x')
    const sideways = vectorAt(column(scene, 'contact_force'), 0)[0]
    numbers.set([rowOf(reaction, 1000, 'mN'), rowOf(gained)])
    remark.textContent = saying(sideways)
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
  controls.append(height.element)

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

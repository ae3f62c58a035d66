/** Step 5: put down gently, it stays; nudged, it goes round a circle. */
import { say } from '../../../viewer/elements'
import type { Scene } from '../../../viewer/scene'
import { h } from '../../dom'
import type { Scenario } from '../../scenario'
import { button } from '../parts/controls'
import { column, finding, sampleAt, vectorAt } from '../parts/measure'
import { rowOf } from '../parts/numbers'
import { PUT_DOWN } from '../parts/scenarios'
import { createStage, playUnlessCalm, simulating } from '../parts/stage'
import type { StepMount } from './place'
import { metres } from './turntable'

export const mountNudge: StepMount = ({ app, stage: host, controls, numbers, worked, remark, offer }) => {
  const stage = createStage(app, { label: 'A ball put down on a turning table' })
  host.append(stage.element)
  stage.viewer.loop = true
  let shown: Scene | null = null
  let nudged = false

  const live = simulating(app, stage, (scene) => {
    stage.viewer.setScenes([scene], { keepTime: false, keepCamera: shown !== null })
    shown = scene
    playUnlessCalm(app, stage.viewer)
    numbers.set([rowOf(finding(scene, '\\varrho'), 100, 'cm'), rowOf(finding(scene, '\\kappa'))])
    worked(scene)
    say(remark, nudged ? 'It comes back to where it was nudged.' : 'It stays, spinning on the spot. Now nudge it.')
  })

  function ask(scenario: Scenario): void {
    offer(scenario)
    live.ask(scenario)
  }

  /** On from where the ball is now, with this much more velocity. */
  function nudge(vx: number, vy: number): void {
    if (!shown) return
    const i = sampleAt(shown, stage.viewer.time)
    const [x, y] = vectorAt(column(shown, 'position'), i)
    const [ux, uy] = vectorAt(column(shown, 'velocity'), i)
    const spin = vectorAt(column(shown, 'angular_velocity'), i)[2]
    nudged = true
    ask({
      ...PUT_DOWN,
      title: 'Steel ball nudged on a level turntable',
      start: {
        position: [metres(x), metres(y)],
        velocity: [speed(ux + vx), speed(uy + vy)],
        spin: Number(spin.toFixed(4)),
      },
    })
  }

  function putBack(): void {
    nudged = false
    ask(PUT_DOWN)
  }

  stage.viewer.tool = 'nudge'
  const off = stage.viewer.on('nudge', ({ vx, vy, done }) => done && nudge(vx, vy))
  controls.append(
    h(
      'div',
      { class: 'buttons' },
      button('Nudge it outward', () => nudge(0.05, 0), 'primary', 'nudge-out'),
      button('Nudge it sideways', () => nudge(0, 0.1), 'plain', 'nudge-aside'),
      button('Put it back', putBack, 'quiet', 'put-back'),
    ),
  )
  ask(PUT_DOWN)
  return () => {
    off()
    live.stop()
    stage.dispose()
  }
}

function speed(metresPerSecond: number): string {
  return `${Number((metresPerSecond * 100).toFixed(3))} cm/s`
}

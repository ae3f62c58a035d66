/** Step 6: guess where the ball goes on a leaning, turning table; then see. */

import { handOver } from '../../../viewer/elements'
import type { Scene } from '../../../viewer/scene'
import { fill, h } from '../../dom'
import { button } from '../parts/controls'
import { finding, pathOf } from '../parts/measure'
import { rowOf } from '../parts/numbers'
import { paragraph } from '../parts/prose'
import { leaning } from '../parts/scenarios'
import { createStage, simulating } from '../parts/stage'
import { inWords, judge, type Point } from './guess'
import { GUESSES, guessed } from './guesses'
import type { StepMount } from './place'
import { AFTER_THE_GUESS } from './texts'

const START: Point = [-0.04, -0.45]
const RIM = 0.5

export const mountTilt: StepMount = ({ app, stage: host, controls, numbers, worked, remark, offer }) => {
  const stage = createStage(app, { label: 'A ball put down on a leaning, turning table' })
  const { viewer } = stage
  const slope = h('p', { class: 'slope-mark' }, 'downhill →')
  stage.element.append(slope)
  host.append(stage.element)
  const tour = host.closest('.tour')
  let scene: Scene | null = null
  let sketch: Point[] = []
  let revealed = false

  const live = simulating(app, stage, (found) => {
    scene = found
    viewer.setScenes([found])
    if (!revealed) hide()
  })

  /** Before the guess: the ball at its start, nothing given away. */
  function hide(): void {
    viewer.pause()
    viewer.seek(0)
    viewer.topView()
    viewer.show = { ...viewer.show, trail: false, guidingCentre: false }
    stage.element.classList.add('bare')
    tour?.classList.add('guessing')
    slope.hidden = false
    viewer.tool = 'draw'
  }

  const letGo = button('Let go', reveal, 'primary', 'let-go')
  const again = button('Guess again', restart, 'quiet', 'guess-again')
  letGo.disabled = true
  again.hidden = true
  const picks = h(
    'div',
    { class: 'buttons', role: 'group', 'aria-label': 'Pick a guess' },
    GUESSES.map(([name, words]) => button(words, () => take(guessed(name, START, RIM)), 'plain', `guess-${name}`)),
  )
  controls.append(picks, h('div', { class: 'buttons' }, letGo, again))

  function take(points: Point[]): void {
    if (revealed) return
    sketch = points
    viewer.setSketch(
      points.map(([x, y]): [number, number] => [x, y]),
      'Your guess',
    )
    letGo.disabled = points.length === 0
    app.announce('Your guess is on the table. Let go to see.')
  }

  function reveal(): void {
    if (!scene) return
    revealed = true
    picks.hidden = true
    letGo.hidden = true
    again.hidden = false
    again.focus()
    viewer.tool = 'orbit'
    viewer.show = { ...viewer.show, trail: true, guidingCentre: true }
    stage.element.classList.remove('bare')
    viewer.loop = false
    viewer.speed = 2
    viewer.seek(app.settings.reducedMotion ? viewer.duration : 0)
    if (!app.settings.reducedMotion) viewer.play()
    else tell()
    // Told when the ball has shown it, not before.
  }

  function tell(): void {
    if (!scene || !revealed || remark.childElementCount) return
    const drift = finding(scene, '|v_d|')
    numbers.set([rowOf(drift, 100, 'cm/s'), rowOf(finding(scene, '\\arg v_d'))])
    worked(scene)
    tour?.classList.remove('guessing')
    const words = inWords(judge(sketch, pathOf(scene), 1))
    fill(
      remark,
      h('p', { class: 'judgement', 'data-testid': 'judgement' }, words),
      AFTER_THE_GUESS.map((text) => paragraph(text)),
    )
    app.announce(words)
  }

  function restart(): void {
    revealed = false
    sketch = []
    picks.hidden = false
    letGo.hidden = false
    letGo.disabled = true
    handOver(again, picks.querySelector('button')!)
    again.hidden = true
    fill(remark)
    numbers.set([])
    worked(null)
    viewer.setSketch(null)
    hide()
  }

  const offs = [
    viewer.on('sketch', ({ points }) => take(points.map(([x, y]) => [x, y] as const))),
    viewer.on('time', () => {
      if (revealed && viewer.time > 0.55 * viewer.duration) tell()
    }),
  ]
  offer(leaning())
  live.ask(leaning())
  return () => {
    for (const off of offs) off()
    live.stop()
    stage.dispose()
  }
}

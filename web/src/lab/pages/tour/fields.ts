/** Step 7: the ball and the charge, moving in step. */
import type { Scenario } from '../../scenario'
import { createPair } from '../fields/pair'
import { slider } from '../parts/controls'
import { apart, finding } from '../parts/measure'
import { rowOf } from '../parts/numbers'
import { leaning } from '../parts/scenarios'
import type { StepMount } from './place'

export const mountFields: StepMount = ({ app, stage, controls, numbers, remark, offer }) => {
  const pair = createPair(app, ({ ball, charge }) => {
    const drift = finding(ball, 'v_d')
    const own = finding(charge, 'v_d', 'E/B', 'v_E')
    numbers.set([rowOf(drift, 100, 'cm/s'), own && { ...rowOf(own, 100, 'cm/s')!, name: 'drift of the charge' }])
    const most = apart(ball, charge)
    remark.textContent =
      most < 1e-6
        ? 'Ball and charge never part: the paths are the same to within a micrometre.'
        : `Apart by up to ${most} m.`
  })
  stage.append(pair.element)
  let tilt = 0.3
  const lean = slider({
    label: 'Tilt of the table, electric field',
    min: -0.3,
    max: 0.3,
    step: 0.01,
    value: tilt,
    words: (degrees) => `${degrees.toFixed(2)}°`.replace('-', '−'),
    change(degrees) {
      tilt = degrees
      ask()
    },
    testid: 'fields-tilt',
  })
  controls.append(lean.element)

  function ask(): void {
    const scenario: Scenario = leaning(`${tilt} deg`)
    offer(scenario)
    pair.ask(scenario)
  }
  ask()
  return () => pair.dispose()
}

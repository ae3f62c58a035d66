/** Step 7: the ball and the charge, moving in step. */

import { say } from '../../../viewer/elements'
import { withPlaces } from '../../../viewer/quantities'
import { show } from '../../quantity'
import type { Scenario } from '../../scenario'
import { chargeOf } from '../fields/charge'
import { createPair } from '../fields/pair'
import { slider } from '../parts/controls'
import { driftSeen, finding } from '../parts/measure'
import { rowOf } from '../parts/numbers'
import { leaning } from '../parts/scenarios'
import type { StepMount } from './place'

export const mountFields: StepMount = ({ app, stage, controls, numbers, worked, remark, offer }) => {
  const pair = createPair(app, ({ ball, charge }) => {
    const { drift, apart } = chargeOf(charge)
    numbers.set([
      rowOf(finding(ball, '|v_d|'), 100, 'cm/s'),
      drift
        ? {
            name: 'the charge’s drift',
            symbol: 'E/B',
            predicted: 100 * Math.hypot(...drift),
            measured: 100 * driftSeen(charge),
            unit: 'cm/s',
          }
        : undefined,
    ])
    worked(ball)
    say(
      remark,
      `Ball and charge never part: their paths, each by its own formulas, differ by ${show(apart, 2)} m, which is rounding.`,
    )
  })
  stage.append(pair.element)
  let tilt = 0.15
  const lean = slider({
    label: 'Tilt of the table, electric field',
    min: -0.3,
    max: 0.3,
    step: 0.01,
    value: tilt,
    words: (degrees) => `${withPlaces(degrees, 2)}°`,
    change(degrees) {
      tilt = degrees
      ask()
    },
    testid: 'fields-tilt',
  })
  controls.append(lean.element)

  function ask(): void {
    const scenario: Scenario = leaning(tilt)
    offer(scenario)
    pair.ask(scenario)
  }
  ask()
  return () => pair.dispose()
}

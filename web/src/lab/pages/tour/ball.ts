/** Step 2: the same two quarter turns in two orders. */
import { createOrders } from '../holonomy/orders'
import { degrees, directionInWords } from '../holonomy/rolling'
import type { StepMount } from './place'

export const mountBall: StepMount = ({ app, stage, controls, numbers }) => {
  const rows = (found: [string | null, string | null, string | null]) =>
    numbers.set([
      { name: 'pole, east then north', predicted: 'east', measured: found[0] },
      { name: 'pole, north then east', predicted: 'north', measured: found[1] },
      { name: 'turned against each other', predicted: '120.00°', measured: found[2] },
    ])
  const orders = createOrders(app, ({ first, second, difference }) => {
    rows([directionInWords(first.north_pole), directionInWords(second.north_pole), degrees(difference.turned)])
  })
  rows([null, null, null])
  stage.append(orders.stages)
  controls.append(orders.controls)
  void orders.set(['E', 'N'], ['N', 'E'])
  return () => orders.dispose()
}

/** The same quarter turns in two orders, and by how much the two ends differ. */
import type { App } from '../../app'
import { fill, h } from '../../dom'
import { choice } from '../parts/controls'
import { createNumbers, type Row } from '../parts/numbers'
import { paragraph } from '../parts/prose'
import { createOrders, type Outcome } from './orders'
import { componentsOf, degrees, directionInWords, RADIUS } from './rolling'
import type { Turn } from './turns'

type Pair = readonly [readonly Turn[], readonly Turn[]]

const PAIRS = {
  one: [
    ['E', 'N'],
    ['N', 'E'],
  ],
  two: [
    ['E', 'E', 'N'],
    ['N', 'E', 'E'],
  ],
  corner: [
    ['E', 'E', 'N', 'N'],
    ['N', 'N', 'E', 'E'],
  ],
} as const satisfies Record<string, Pair>

const NAMES = [
  ['one', 'One east, one north'],
  ['two', 'Two east, one north'],
  ['corner', 'Two and two'],
] as const

export function mountTwoOrders(host: HTMLElement, app: App): () => void {
  const numbers = createNumbers('How the two ends differ')
  const orders = createOrders(app, (outcome) => numbers.set(rows(outcome)))

  function take(name: keyof typeof PAIRS): void {
    numbers.set([])
    const [first, second] = PAIRS[name]
    void orders.set(first, second)
  }

  const which = choice('Quarter turns', NAMES, 'one', take)
  fill(
    host,
    h(
      'div',
      { class: 'lesson spread' },
      h(
        'div',
        { class: 'spread-text' },
        h('p', { class: 'kicker' }, 'One place, two orientations'),
        h('h1', {}, 'The order counts'),
        paragraph(
          'Both balls end at the same spot. To get from the one end to the other without lifting the ball, roll back along the first way and out along the second: *a closed loop*. What that loop turns the ball by is the difference between the two orders.',
        ),
        which.element,
        orders.controls,
        numbers.element,
      ),
      h('div', { class: 'spread-stage' }, orders.stages),
    ),
  )
  take('one')
  return () => orders.dispose()
}

function rows({ first, second, difference }: Outcome): Row[] {
  const one = (name: string, measured: string): Row => ({ name, predicted: null, measured })
  return [
    one('first pole', directionInWords(first.north_pole)),
    one('second pole', directionInWords(second.north_pole)),
    one('turned against each other', degrees(difference.turned)),
    one('about the axis (east, north, up)', componentsOf(difference.turned_axis)),
    one(
      'area between the two ways',
      `${((difference.enclosed_area ?? 0) / RADIUS ** 2).toFixed(3)} a²`.replace('-', '−'),
    ),
  ]
}

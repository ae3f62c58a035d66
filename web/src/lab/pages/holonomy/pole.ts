/** A small map of the ball from above: where its north pole is now. Full where it is on the upper half, hollow below. */
import { say } from '../../../viewer/elements'
import { h, svg } from '../../dom'
import type { Vector } from '../parts/measure'
import { directionInWords } from './rolling'

export interface PoleMap {
  readonly element: HTMLElement
  set(pole: Vector): void
}

const SIZE = 40

export function createPoleMap(label = 'North pole'): PoleMap {
  const line = svg('line', { x1: 0, y1: 0, x2: 0, y2: 0, class: 'pole-line' })
  const dot = svg('circle', { r: 5, class: 'pole-dot' })
  const rim = svg('circle', { r: SIZE, class: 'pole-rim' })
  const letters = (
    [
      ['N', 0, -SIZE - 9],
      ['E', SIZE + 13, 4],
      ['S', 0, SIZE + 17],
      ['W', -SIZE - 14, 4],
    ] as const
  ).map(([text, x, y]) => svg('text', { x, y, class: 'pole-letter' }, text))
  const map = svg(
    'svg',
    { viewBox: '-60 -60 120 120', class: 'pole-map', 'aria-hidden': 'true' },
    rim,
    ...letters,
    line,
    dot,
  )
  const words = h('output', { class: 'pole-words', 'data-testid': 'pole' })
  const element = h('div', { class: 'pole' }, map, h('p', {}, h('span', { class: 'pole-label' }, `${label} `), words))
  return {
    element,
    set(pole) {
      const [x, y] = [pole[0] * SIZE, -pole[1] * SIZE]
      dot.setAttribute('cx', x.toFixed(2))
      dot.setAttribute('cy', y.toFixed(2))
      line.setAttribute('x2', x.toFixed(2))
      line.setAttribute('y2', y.toFixed(2))
      element.classList.toggle('pole-below', pole[2] < -1e-3)
      say(words, directionInWords(pole))
    },
  }
}

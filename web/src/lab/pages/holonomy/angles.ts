/** A small chart that fills as loops are tried: the angle turned over the area enclosed, with the rule as a line. */
import { h, svg } from '../../dom'
import type { Shape } from './turns'

export interface Angles {
  readonly element: HTMLElement
  /** Area in radii squared, angle in radians. */
  add(shape: Shape, area: number, angle: number): void
}

const [WIDTH, HEIGHT] = [240, 150]
const EDGE = { left: 44, right: 10, top: 10, bottom: 34 }
const MOST = Math.PI

export function createAngles(): Angles {
  const dots = svg('g', {})
  const tried = new Set<string>()
  const chart = svg(
    'svg',
    {
      viewBox: `0 0 ${WIDTH} ${HEIGHT}`,
      class: 'angles-chart',
      role: 'img',
      'aria-label': 'Angle turned over area enclosed',
    },
    svg('path', { class: 'axis', d: `M${x(0)} ${y(MOST)}V${y(0)}H${x(MOST)}` }),
    svg('line', { class: 'rule', x1: x(0), y1: y(0), x2: x(MOST), y2: y(MOST) }),
    [1, 2, 3].map((tick) => svg('text', { x: x(tick), y: y(0) + 13, class: 'tick middle' }, `${tick} a²`)),
    [60, 120, 180].map((tick) =>
      svg('text', { x: x(0) - 5, y: y((tick * Math.PI) / 180) + 4, class: 'tick end' }, `${tick}°`),
    ),
    svg('text', { x: x(MOST / 2), y: HEIGHT - 4, class: 'tick middle' }, 'area enclosed'),
    dots,
  )
  return {
    element: h(
      'figure',
      { class: 'angles' },
      chart,
      h(
        'figcaption',
        {},
        'The angle turned, over the area enclosed. Each loop that you try leaves a dot; the line is the rule for small ones.',
      ),
    ),
    add(shape, area, angle) {
      const key = `${shape} ${area.toFixed(4)}`
      for (const dot of dots.children) dot.classList.remove('newest')
      if (tried.has(key)) {
        dots.querySelector(`[data-key="${key}"]`)?.classList.add('newest')
        return
      }
      tried.add(key)
      const [cx, cy] = [x(Math.min(area, MOST)), y(angle)]
      const mark =
        shape === 'circle'
          ? svg('circle', { cx, cy, r: 3.5, class: 'dot newest', 'data-key': key })
          : svg('rect', { x: cx - 3.2, y: cy - 3.2, width: 6.4, height: 6.4, class: 'dot newest', 'data-key': key })
      dots.append(mark)
    },
  }
}

function x(area: number): number {
  return EDGE.left + (area / MOST) * (WIDTH - EDGE.left - EDGE.right)
}

function y(angle: number): number {
  return HEIGHT - EDGE.bottom - (angle / MOST) * (HEIGHT - EDGE.top - EDGE.bottom)
}

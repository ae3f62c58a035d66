/** The ball from the side: where it is pushed, and which way the table answers. Lengths of the arrows to one scale. */
import { say } from '../../../viewer/elements'
import { svg } from '../../dom'

export interface PushDiagram {
  readonly element: SVGSVGElement
  /** The height of the push in radii, and the table's answer as a share of it. */
  set(height: number, reaction: number): void
}

const RADIUS = 34
const PUSH = 46
const HEAD = 7

export function createPushDiagram(): PushDiagram {
  const push = arrow('push')
  const answer = arrow('reaction')
  const level = svg('line', { class: 'push-level' })
  const pushName = svg('text', { class: 'push-name' }, 'F')
  const answerName = svg('text', { class: 'push-name reaction' }, 'Rₓ')
  const element = svg(
    'svg',
    { viewBox: '-104 -52 200 108', class: 'push-diagram', role: 'img', 'aria-label': 'The ball from the side' },
    svg('line', { class: 'push-table', x1: -100, y1: RADIUS, x2: 92, y2: RADIUS }),
    svg('circle', { class: 'push-ball', r: RADIUS }),
    svg('circle', { class: 'push-centre', r: 2.2 }),
    level,
    push,
    answer,
    pushName,
    answerName,
  )
  return {
    element,
    set(height, reaction) {
      const y = -height * RADIUS
      const left = -Math.sqrt(Math.max(0, RADIUS * RADIUS - y * y))
      level.setAttribute('x1', '0')
      level.setAttribute('x2', String(left))
      level.setAttribute('y1', String(y))
      level.setAttribute('y2', String(y))
      push.setAttribute('d', path(left - PUSH, left, y))
      pushName.setAttribute('x', String(left - PUSH - 10))
      pushName.setAttribute('y', String(y + 4))
      const reach = reaction * PUSH
      answer.setAttribute('d', Math.abs(reach) < 0.5 ? '' : path(0, reach, RADIUS + 8))
      answerName.setAttribute('x', String(reach + (reach < 0 ? -10 : 8)))
      answerName.setAttribute('y', String(RADIUS + 12))
      say(answerName, Math.abs(reach) < 0.5 ? 'Rₓ = 0' : 'Rₓ')
    },
  }
}

function arrow(name: string): SVGPathElement {
  return svg('path', { class: `push-arrow ${name}` })
}

/** Along a level, from one place to another, with a head where there is room for one. */
function path(from: number, to: number, y: number): string {
  const way = Math.sign(to - from)
  const head = Math.min(HEAD, Math.abs(to - from))
  const back = to - way * head
  return `M${from} ${y}H${to}M${back} ${y - head * 0.6}L${to} ${y}L${back} ${y + head * 0.6}`
}

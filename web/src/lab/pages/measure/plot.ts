/** What was measured, as points, and the path of the fit, as a line: step by step as the fit went. */
import { t } from '../../../languages/translate'
import { put } from '../../../viewer/elements'
import type { Track, TrackColumns, Way } from '../../api'
import { fill, h, uniqueId } from '../../dom'
import { show } from '../../quantity'
import { roundNumbers } from '../maps/axes'

export interface Plot {
  readonly element: HTMLElement
  measured(track: Pick<Track, 'columns' | 'units'>): void
  /** Show the way of a fit from its beginning, or at once where it ended; null takes it away. */
  way(way: Way | null, calm: boolean): void
  restyle(): void
  dispose(): void
}

type Line = (readonly [number, number] | null)[]

export interface Drawn {
  names: [string, string]
  /** Both axes alike. */
  square: boolean
  points: Line[]
  /** What each line is, where they are several. */
  called: string[]
}

const FITTED = '--series-2'
const MEASURED = ['--series-1', '--series-3', '--series-4', '--series-5']
const LASTS = 1600 // ms, of the way of a fit

/** The path where x and y were measured, else each column over time. */
export function drawnOf(columns: TrackColumns, units: Record<string, string>): Drawn {
  const { t = [], x, y, ...others } = columns
  if (x && y) return { names: ['x, m', 'y, m'], square: true, points: [paired(x, y)], called: [] }
  const rest = Object.entries(x ? { x, ...others } : y ? { y, ...others } : others)
  const names = rest.map(([name]) => name)
  return {
    names: ['t, s', told(names, units)],
    square: false,
    points: rest.map(([, column]) => paired(t, column)),
    called: names.length > 1 ? names : [],
  }
}

/** Names of columns, those of one unit together: 'x, m; wy, wz, rad/s'. */
function told(names: string[], units: Record<string, string>): string {
  const groups = new Map<string, string[]>()
  for (const name of names) {
    const unit = units[name] ?? ''
    groups.set(unit, [...(groups.get(unit) ?? []), name])
  }
  return [...groups].map(([unit, those]) => [...those, ...(unit ? [unit] : [])].join(', ')).join('; ')
}

/** The same of a step of the fit. */
export function stepOf(way: Way, place: number, units: Record<string, string>): Drawn {
  const frame = way.frames[place]!
  const columns = Object.fromEntries(way.columns.map((name, i) => [name, frame.columns[i]!]))
  return drawnOf({ t: way.time, ...columns }, units)
}

function paired(across: (number | null)[], up: (number | null)[]): Line {
  return across.map((a, i) => {
    const b = up[i]
    return a === null || b === null || b === undefined ? null : ([a, b] as const)
  })
}

/** Least and largest, with room about them; of a square plot both sides as long, in m a pixel. */
export function rangesOf(points: Line[], square: boolean, wide: number, high: number): [number, number][] {
  const known = points.flat().filter((point) => point !== null)
  const ranges = [0, 1].map((axis): [number, number] => {
    let [low, most] = [Infinity, -Infinity]
    for (const point of known) {
      low = Math.min(low, point[axis]!)
      most = Math.max(most, point[axis]!)
    }
    if (!(most >= low)) return [0, 1]
    const room = (most - low || Math.abs(most) || 1) * 0.06
    return [low - room, most + room]
  })
  if (!square) return ranges
  const scale = Math.max(...ranges.map(([low, most], i) => (most - low) / [wide, high][i]!))
  return ranges.map(([low, most], i): [number, number] => {
    const half = (scale * [wide, high][i]!) / 2
    return [(low + most) / 2 - half, (low + most) / 2 + half]
  })
}

export function createPlot(): Plot {
  const canvas = h('canvas', { class: 'measure-canvas', role: 'img', 'aria-label': 'What was measured' })
  const id = uniqueId('step')
  const step = h('input', {
    class: 'slider',
    type: 'range',
    id,
    min: 0,
    max: 0,
    step: 1,
    value: 0,
    'data-testid': 'fit-step',
  })
  const said = h('output', { for: id, class: 'number', 'data-testid': 'fit-said' })
  const steps = h('div', { class: 'dial', hidden: true }, h('label', { for: id }, 'Step of the fit'), said, step)
  const legend = h('p', { class: 'measure-legend' })
  const element = h('div', { class: 'measure-plot', 'data-empty': true }, canvas, legend, steps)
  let track: Pick<Track, 'columns' | 'units'> | null = null
  let found: Way | null = null
  let frame = 0

  step.addEventListener('input', () => {
    cancelAnimationFrame(frame)
    present()
  })

  function present(): void {
    if (found) {
      const place = Number(step.value)
      const { reduced, share } = found.frames[place]!
      const last = found.frames.length - 1
      const part = share < 1 ? `, of the first ${Math.round(share * 100)} % of the time` : ''
      fill(said, `${place === last ? 'the end' : `${place + 1} of ${last + 1}`}: χ²/dof ${show(reduced, 3)}${part}`)
      put(step, 'aria-valuetext', said.textContent ?? '')
      step.style.setProperty('--to', `${last ? (100 * place) / last : 100}%`)
    }
    paint()
  }

  function paint(): void {
    const box = canvas.getBoundingClientRect()
    const context = canvas.getContext('2d')
    if (!context || !track || box.width === 0) return
    const ratio = window.devicePixelRatio || 1
    canvas.width = Math.round(box.width * ratio)
    canvas.height = Math.round(box.height * ratio)
    context.scale(ratio, ratio)
    const drawn = drawnOf(track.columns, track.units)
    const line = found ? stepOf(found, Number(step.value), track.units) : null
    tellApart(drawn, line !== null)
    draw(context, box.width, box.height, drawn, line, canvas)
  }

  function tellApart({ called }: Drawn, fit: boolean): void {
    const key = (series: string, words: string, kind: string) => {
      const sample = h('span', { class: `measure-key ${kind}`, 'aria-hidden': true })
      sample.style.background = `var(${series})`
      return h('span', {}, sample, words)
    }
    const names = called.length ? called.map((name) => t('{name}, measured', { name })) : ['measured']
    fill(
      legend,
      names.map((words, i) => key(MEASURED[i % MEASURED.length]!, words, 'points')),
      fit ? key(FITTED, 'the fit', 'line') : null,
    )
  }

  const watcher = new ResizeObserver(() => paint())
  watcher.observe(canvas)

  return {
    element,
    measured(next) {
      track = next
      element.removeAttribute('data-empty')
      found = null
      steps.hidden = true
      paint()
    },
    way(next, calm) {
      cancelAnimationFrame(frame)
      found = next
      steps.hidden = next === null
      if (!next) {
        paint()
        return
      }
      const last = next.frames.length - 1
      step.max = String(last)
      const began = performance.now()
      const go = () => {
        const share = calm ? 1 : Math.min(1, (performance.now() - began) / LASTS)
        step.value = String(Math.round(share * last))
        present()
        if (share < 1) frame = requestAnimationFrame(go)
      }
      go()
    },
    restyle: paint,
    dispose() {
      cancelAnimationFrame(frame)
      watcher.disconnect()
    },
  }
}

const EDGE = { left: 62, right: 12, top: 10, bottom: 40 }

function draw(
  context: CanvasRenderingContext2D,
  width: number,
  height: number,
  drawn: Drawn,
  line: Drawn | null,
  canvas: HTMLElement,
): void {
  const style = getComputedStyle(canvas)
  const read = (name: string) => style.getPropertyValue(name).trim()
  const rem = Number.parseFloat(getComputedStyle(document.documentElement).fontSize) / 16 || 1
  const [left, top] = [EDGE.left * rem, EDGE.top * rem]
  const [wide, high] = [width - left - EDGE.right * rem, height - top - EDGE.bottom * rem]
  const [across, up] = rangesOf(drawn.points, drawn.square, wide, high) as [[number, number], [number, number]]
  const at = (point: readonly [number, number]): [number, number] => [
    left + ((point[0] - across[0]) / (across[1] - across[0])) * wide,
    top + (1 - (point[1] - up[0]) / (up[1] - up[0])) * high,
  ]
  context.clearRect(0, 0, width, height)
  context.font = `${12 * rem}px ${read('--font-number')}`
  context.fillStyle = read('--ink-2')
  context.strokeStyle = read('--line')
  context.textBaseline = 'middle'
  for (const value of roundNumbers(across[0], across[1], 6)) {
    const [x] = at([value, up[0]])
    rule(context, x, top, x, top + high)
    context.textAlign = 'center'
    context.fillText(t(show(value)), x, top + high + 12 * rem)
  }
  for (const value of roundNumbers(up[0], up[1], 6)) {
    const [, y] = at([across[0], value])
    rule(context, left, y, left + wide, y)
    context.textAlign = 'right'
    context.fillText(t(show(value)), left - 6 * rem, y)
  }
  context.textAlign = 'center'
  context.fillText(t(drawn.names[0]), left + wide / 2, height - 10 * rem)
  context.save()
  context.translate(10 * rem, top + high / 2)
  context.rotate(-Math.PI / 2)
  context.fillText(t(drawn.names[1]), 0, 0)
  context.restore()
  context.save()
  context.beginPath()
  context.rect(left, top, wide, high)
  context.clip()
  drawn.points.forEach((points, i) => {
    context.fillStyle = read(MEASURED[i % MEASURED.length]!)
    for (const point of points) {
      if (!point) continue
      const [x, y] = at(point)
      context.fillRect(x - 1.5 * rem, y - 1.5 * rem, 3 * rem, 3 * rem)
    }
  })
  context.strokeStyle = read(FITTED)
  context.lineWidth = 2 * rem
  for (const points of line?.points ?? []) {
    context.beginPath()
    points.forEach((point) => {
      if (point) context.lineTo(...at(point))
    })
    context.stroke()
  }
  context.restore()
}

function rule(context: CanvasRenderingContext2D, x: number, y: number, toX: number, toY: number): void {
  context.beginPath()
  context.moveTo(x, y)
  context.lineTo(toX, toY)
  context.stroke()
}

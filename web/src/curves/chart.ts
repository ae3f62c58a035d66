/** A curve as SVG, on the page and in files: one quantity over another, events marked, and where the film is. */
import { svg } from '../lab/dom'
import { show } from '../lab/quantity'

export interface Axis {
  label: string
  unit: string
  /** Not a number where there is none. */
  values: ArrayLike<number>
}

export interface Plot {
  x: Axis
  y: Axis
  time: ArrayLike<number>
  /** When something happens. */
  events: readonly number[]
}

export interface Look {
  ink: string
  grid: string
  line: string
  event: string
  paper: string
  /** Of the line, px. */
  width: number
  font: string
  size: number
}

export interface Chart {
  element: SVGSVGElement
  /** Mark a sample. */
  at(index: number): void
  /** The sample nearest to a place in the picture. */
  nearest(x: number, y: number): number
}

interface Scale {
  low: number
  high: number
  ticks: number[]
  at(value: number): number
}

/** Round numbers between two ends: 1, 2 or 5 in some decade, about so many. */
export function ticks(low: number, high: number, about: number): number[] {
  const rough = (high - low) / Math.max(1, about)
  if (!(rough > 0) || !Number.isFinite(rough)) return [low]
  const decade = 10 ** Math.floor(Math.log10(rough))
  const step = decade * ([1, 2, 5, 10].find((part) => part * decade >= rough) ?? 10)
  const first = Math.ceil(low / step - 1e-9)
  const count = Math.floor(high / step + 1e-9) - first
  return Array.from({ length: count + 1 }, (_, i) => Number(((first + i) * step).toPrecision(12)))
}

function extent(values: ArrayLike<number>): [number, number] {
  let [low, high] = [Infinity, -Infinity]
  for (let i = 0; i < values.length; i++) {
    const value = values[i]!
    if (value < low) low = value
    if (value > high) high = value
  }
  return low <= high ? [low, high] : [0, 1]
}

/** With room at both ends, unless it is time; one that is almost level is shown as level. */
function scaled(axis: Axis, from: number, to: number, about: number, room: number): Scale {
  const [least, most] = extent(axis.values)
  const middle = (least + most) / 2
  const level = least === 0 && most === 0 ? 1 : 1e-9
  const spread = Math.max(most - least, Math.abs(middle) * 1e-3, level) * (0.5 + room)
  const [low, high] = room ? [middle - spread, middle + spread] : [least, Math.max(most, least + 1e-9)]
  return {
    low,
    high,
    ticks: ticks(low, high, about),
    at: (value) => from + ((value - low) / (high - low)) * (to - from),
  }
}

/** A path through the points, broken where there is no number; of many in one column of pixels the ends and extremes. */
export function pathOf(xs: ArrayLike<number>, ys: ArrayLike<number>, byColumn: boolean): string {
  let path = ''
  let pen = false
  let column = Number.NaN
  let held: [number, number][] = []
  const put = (x: number, y: number) => {
    path += `${pen ? 'L' : 'M'}${x.toFixed(1)} ${y.toFixed(1)}`
    pen = true
  }
  const flush = () => {
    if (held.length <= 4) for (const [x, y] of held) put(x, y)
    else {
      const order = held.map((_, i) => i).sort((a, b) => held[a]![1] - held[b]![1])
      const kept = [...new Set([0, order[0]!, order.at(-1)!, held.length - 1])].sort((a, b) => a - b)
      for (const i of kept) put(...held[i]!)
    }
    held = []
  }
  for (let i = 0; i < xs.length; i++) {
    const [x, y] = [xs[i]!, ys[i]!]
    if (!Number.isFinite(x) || !Number.isFinite(y)) {
      flush()
      pen = false
    } else if (byColumn) {
      if (Math.floor(x) !== column) flush()
      column = Math.floor(x)
      held.push([x, y])
    } else put(x, y)
  }
  flush()
  return path
}

/** `named`: with the names of the axes, as a picture needs them that stands alone. */
export function createChart(plot: Plot, look: Look, width: number, height: number, named = false): Chart {
  const { size } = look
  const overTime = plot.x.values === plot.time
  const left = size * (named ? 6.2 : 4.6)
  const [right, top] = [width - size, size * 0.7]
  const bottom = height - size * (named ? 3.4 : 1.9)
  const x = scaled(plot.x, left, right, width / (size * 7), overTime ? 0 : 0.06)
  const y = scaled(plot.y, bottom, top, height / (size * 3), 0.08)
  const word = { fill: look.ink, 'font-family': look.font, 'font-size': size }
  const told = (value: number) => show(value, 4)

  const rules = [
    ...x.ticks.map((value) => line(x.at(value), top, x.at(value), bottom, look.grid)),
    ...y.ticks.map((value) => line(left, y.at(value), right, y.at(value), look.grid)),
    ...x.ticks.map((value) =>
      svg('text', { ...word, x: x.at(value), y: bottom + size * 1.3, 'text-anchor': 'middle' }, told(value)),
    ),
    ...y.ticks.map((value) =>
      svg('text', { ...word, x: left - size * 0.5, y: y.at(value) + size * 0.35, 'text-anchor': 'end' }, told(value)),
    ),
  ]
  const xs = Float64Array.from(plot.x.values, (value) => x.at(value))
  const ys = Float64Array.from(plot.y.values, (value) => y.at(value))
  const curve = svg('path', {
    d: pathOf(xs, ys, overTime),
    fill: 'none',
    stroke: look.line,
    'stroke-width': overTime ? look.width : 0.6 * look.width,
    'stroke-linejoin': 'round',
  })
  const events = plot.events.map((when) => {
    const index = indexBefore(plot.time, when)
    return overTime
      ? line(x.at(when), top, x.at(when), bottom, look.event, '4 4')
      : svg('circle', { cx: xs[index] ?? 0, cy: ys[index] ?? 0, r: 4, fill: 'none', stroke: look.event })
  })
  const cursor = line(0, top, 0, bottom, look.ink)
  cursor.setAttribute('class', 'playhead')
  const dot = svg('circle', { r: 4, fill: look.line, stroke: look.paper, class: 'playdot' })
  const names = named
    ? [
        svg('text', { ...word, x: (left + right) / 2, y: height - size * 0.7, 'text-anchor': 'middle' }, title(plot.x)),
        svg(
          'text',
          {
            ...word,
            transform: `translate(${size * 1.2} ${(top + bottom) / 2}) rotate(-90)`,
            'text-anchor': 'middle',
          },
          title(plot.y),
        ),
      ]
    : []
  const element = svg(
    'svg',
    { viewBox: `0 0 ${width} ${height}`, width, height, 'font-variant-numeric': 'tabular-nums' },
    named ? svg('rect', { width, height, fill: look.paper }) : null,
    rules,
    names,
    events,
    curve,
    named ? [] : [overTime ? cursor : null, dot],
  )
  return {
    element,
    at(index) {
      const [px, py] = [xs[index] ?? left, ys[index] ?? Number.NaN]
      cursor.setAttribute('transform', `translate(${px} 0)`)
      const known = Number.isFinite(py) && Number.isFinite(px)
      dot.toggleAttribute('hidden', !known)
      dot.setAttribute('visibility', known ? 'visible' : 'hidden')
      if (known) dot.setAttribute('transform', `translate(${px} ${py})`)
    },
    nearest(px, py) {
      let [found, least] = [0, Infinity]
      for (let i = 0; i < xs.length; i++) {
        const off = overTime ? Math.abs(xs[i]! - px) : Math.hypot(xs[i]! - px, ys[i]! - py)
        if (off < least) [found, least] = [i, off]
      }
      return found
    },
  }
}

export function title({ label, unit }: Axis): string {
  return unit ? `${label} (${unit})` : label
}

function line(x1: number, y1: number, x2: number, y2: number, stroke: string, dashes?: string): SVGLineElement {
  return svg('line', { x1, y1, x2, y2, stroke, 'stroke-dasharray': dashes })
}

/** Index of the last sample at or before a time. */
export function indexBefore(times: ArrayLike<number>, time: number): number {
  let [low, high] = [0, times.length - 1]
  while (low < high) {
    const middle = Math.ceil((low + high) / 2)
    if (times[middle]! <= time) low = middle
    else high = middle - 1
  }
  return low
}

/** A curve over the time, with a cursor that goes with the film. */
import { element, say } from '../viewer/elements'
import { shortNumber } from '../viewer/quantities'
import type { Course } from './course'
import type { Curve } from './header'

const SVG = 'http://www.w3.org/2000/svg'
const [WIDTH, HEIGHT] = [1000, 200]
const MOST = 900 // pairs of points of a curve

export class Graph {
  readonly element: HTMLElement
  private readonly line = document.createElementNS(SVG, 'path')
  private readonly zero = document.createElementNS(SVG, 'path')
  private readonly cursor = document.createElementNS(SVG, 'path')
  private readonly marks = document.createElementNS(SVG, 'path')
  private readonly choice = element('select', '', { 'aria-label': 'Curve' })
  private readonly most = element('span', 'live-most')
  private readonly least = element('span', 'live-least')
  private readonly begin = element('span', 'live-begin')
  private readonly end = element('span', 'live-end')
  private readonly now = element('span', 'live-now')
  private course: Course | null = null
  private span: [number, number] = [0, 1]
  private time = 0

  constructor(
    private readonly curves: readonly Curve[],
    seek: (time: number) => void,
  ) {
    const svg = document.createElementNS(SVG, 'svg')
    svg.setAttribute('viewBox', `0 0 ${WIDTH} ${HEIGHT}`)
    svg.setAttribute('preserveAspectRatio', 'none')
    svg.setAttribute('aria-hidden', 'true')
    for (const [part, name] of [
      [this.zero, 'zero'],
      [this.marks, 'marks'],
      [this.line, 'line'],
      [this.cursor, 'cursor'],
    ] as const) {
      part.setAttribute('class', `live-${name}`)
      svg.append(part)
    }
    for (const [i, { name, unit }] of curves.entries())
      this.choice.append(
        element('option', '', { value: String(i) }, `${name[0]!.toUpperCase()}${name.slice(1)}, ${unit}`),
      )
    this.choice.addEventListener('change', () => this.draw())
    const look = (event: PointerEvent) => {
      if (event.buttons === 0 || !this.course) return
      const { left, width } = svg.getBoundingClientRect()
      const share = Math.min(1, Math.max(0, (event.clientX - left) / width))
      seek(this.span[0] + share * (this.span[1] - this.span[0]))
    }
    svg.addEventListener('pointerdown', look)
    svg.addEventListener('pointermove', look)
    const head = element('div', 'live-graph-head', {}, this.choice, this.now)
    const heights = element('div', 'live-heights', {}, this.most, this.least)
    const field = element('div', 'live-field', {}, heights, svg)
    const foot = element('div', 'live-graph-foot', {}, this.begin, this.end)
    this.element = element('section', 'live-graph', { 'aria-label': 'Curve over the time' }, head, field, foot)
  }

  show(course: Course): void {
    this.course = course
    const { time } = course
    this.span = [time[0]!, Math.max(time[time.length - 1]!, time[0]! + 1e-9)]
    this.draw()
  }

  /** Put the cursor to an instant of the film, counted from its first. */
  at(time: number): void {
    this.time = time
    if (!this.course) return
    const x = (WIDTH * time) / (this.span[1] - this.span[0])
    this.cursor.setAttribute('d', `M${x.toFixed(1)} 0V${HEIGHT}`)
    const { column, unit } = this.curve
    const row = this.course.rows[behind(this.course.time, time + this.span[0])]
    if (row) say(this.now, `${time.toFixed(2)} s: ${shortNumber(row[column]!)} ${unit}`)
  }

  private get curve(): Curve {
    return this.curves[Number(this.choice.value)]!
  }

  private draw(): void {
    if (!this.course) return
    const { column } = this.curve
    const { time, rows, events } = this.course
    const step = Math.max(1, Math.floor(rows.length / MOST))
    let [low, high] = [Number.POSITIVE_INFINITY, Number.NEGATIVE_INFINITY]
    for (const row of rows) {
      if (!Number.isFinite(row[column]!)) continue
      low = Math.min(low, row[column]!)
      high = Math.max(high, row[column]!)
    }
    // What changes by rounding alone is drawn as the straight line that it is.
    const room = Math.max(high - low, 1e-9 * Math.max(Math.abs(high), Math.abs(low)), 1e-12)
    const middle = 0.5 * (low + high)
    ;[low, high] = [Math.min(low, middle - room / 2), Math.max(high, middle + room / 2)]
    const [first, last] = this.span
    const x = (t: number) => ((WIDTH * (t - first)) / (last - first)).toFixed(1)
    const y = (value: number) => (HEIGHT * (0.96 - (0.92 * (value - low)) / (high - low))).toFixed(2)
    const points = enveloped(rows, column, step).map((i) => `${x(time[i]!)} ${y(rows[i]![column]!)}`)
    this.line.setAttribute('d', `M${points.join('L')}`)
    this.zero.setAttribute('d', low < 0 && high > 0 ? `M0 ${y(0)}H${WIDTH}` : '')
    this.marks.setAttribute('d', events.map((event) => `M${x(event.time)} 0V${HEIGHT}`).join(''))
    say(this.most, shortNumber(high))
    say(this.least, shortNumber(low))
    say(this.begin, `${shortNumber(first)} s`)
    say(this.end, `${shortNumber(last)} s`)
    this.at(this.time)
  }
}

/** Which rows a curve is drawn through: of each few those with the least and the most, so that no peak is lost. */
export function enveloped(rows: readonly (readonly number[])[], column: number, few: number): number[] {
  const found: number[] = []
  for (let i = 0; i < rows.length; i += few) {
    let [low, high] = [-1, -1]
    for (let j = i; j < Math.min(i + few, rows.length); j++) {
      const value = rows[j]![column]!
      if (!Number.isFinite(value)) continue
      if (low < 0 || value < rows[low]![column]!) low = j
      if (high < 0 || value > rows[high]![column]!) high = j
    }
    if (low >= 0) found.push(...(low === high ? [low] : [Math.min(low, high), Math.max(low, high)]))
  }
  return found
}

/** The last of ascending instants that is not beyond another. */
export function behind(times: readonly number[], time: number): number {
  let [low, high] = [0, times.length - 1]
  while (low < high) {
    const middle = (low + high + 1) >> 1
    if (times[middle]! <= time) low = middle
    else high = middle - 1
  }
  return low
}

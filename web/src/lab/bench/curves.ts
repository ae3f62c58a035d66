/** Curves over time, by uPlot: two of them, each of a quantity that is chosen; a click goes to that instant. */
import uPlot from 'uplot'
import 'uplot/dist/uPlot.min.css'
import type { Scene } from '../../viewer/scene'
import { fill, h } from '../dom'
import { show } from '../quantity'
import { QUANTITIES, type Quantity } from './series'

export interface Curves {
  element: HTMLElement
  update(scene: Scene): void
  /** Where the film is: a line across the curves. */
  at(time: number): void
  /** Theme or size of type have changed. */
  restyle(): void
  dispose(): void
}

interface Chart {
  element: HTMLElement
  draw(scene: Scene): void
  at(time: number): void
  dispose(): void
}

function colours(
  element: HTMLElement,
): Record<'ink' | 'grid' | 'line' | 'event', string> & { width: number; font: string; size: number } {
  const style = getComputedStyle(element)
  const read = (name: string) => style.getPropertyValue(name).trim()
  const size = parseFloat(getComputedStyle(document.documentElement).fontSize) * 0.75
  return {
    ink: read('--ink-2'),
    grid: read('--line'),
    line: read('--series-1'),
    event: read('--series-2'),
    width: Number(read('--plot-line')) || 1.5,
    font: `${size}px ${read('--font-number')}`,
    size,
  }
}

/** A range with room above and below; one that is almost level is shown as level. */
function range(low: number | null, high: number | null): [number, number] {
  const from = low ?? 0
  const to = high ?? 1
  const middle = (from + to) / 2
  const spread = Math.max(to - from, Math.abs(middle) * 1e-3, 1e-9)
  return [middle - spread * 0.58, middle + spread * 0.58]
}

function createChart(first: string, seek: (time: number) => void): Chart {
  let chosen = first
  let scene: Scene | undefined
  let plot: uPlot | undefined
  let time = 0
  const select = h('select', { class: 'curve-choice', 'aria-label': 'Quantity of this curve' })
  const reading = h('output', { class: 'curve-reading' })
  const place = h('div', { class: 'curve-place', role: 'img' })
  const head = h('div', { class: 'curve-head' }, select, reading)
  const element = h('figure', { class: 'curve' }, head, place)
  const line = h('div', { class: 'playhead', 'aria-hidden': 'true' })
  let values: (number | null)[] = []
  let now: Quantity | undefined

  select.addEventListener('change', () => {
    chosen = select.value
    if (scene) draw(scene)
  })

  function draw(next: Scene): void {
    scene = next
    const there = QUANTITIES.filter((one) => one.has(next))
    now = there.find((one) => one.id === chosen) ?? there[0]
    if (!now) return
    fill(
      select,
      there.map((one) => h('option', { value: one.id }, one.label)),
    )
    select.value = now.id
    values = now.values(next)
    const data: uPlot.AlignedData = [Array.from(next.columns.time), values]
    plot?.destroy()
    plot = new uPlot(options(next, now), data, place)
    plot.over.append(line)
    plot.over.addEventListener('click', () => {
      const left = plot?.cursor.left
      if (plot && left !== undefined && left >= 0) seek(plot.posToVal(left, 'x'))
    })
    const known = values.filter((value): value is number => value !== null)
    const least = known.reduce((a, b) => Math.min(a, b), Infinity)
    const most = known.reduce((a, b) => Math.max(a, b), -Infinity)
    place.setAttribute('aria-label', `${now.label} over time: from ${show(least)} to ${show(most)} ${now.unit}`)
    at(time)
  }

  function options(of: Scene, quantity: Quantity): uPlot.Options {
    const { ink, grid, line: stroke, event, width, font, size } = colours(element)
    const axis = { stroke: ink, font, grid: { stroke: grid, width: 1 }, ticks: { show: false }, gap: 4 }
    const short = (_: uPlot, splits: number[]) => splits.map((value) => show(value, 4))
    return {
      width: Math.max(160, place.clientWidth || 300),
      height: Math.round(size * 14),
      padding: [size * 0.6, size * 0.8, 0, 0],
      legend: { show: false },
      cursor: { points: { size: 7 }, drag: { x: false, y: false }, y: false },
      scales: { x: { time: false }, y: { range: (_, low, high) => range(low, high) } },
      axes: [
        { ...axis, size: size * 2, space: size * 6, values: short },
        { ...axis, size: size * 5, space: size * 2.6, values: short },
      ],
      series: [{}, { label: quantity.label, stroke, width, points: { show: false } }],
      hooks: {
        draw: [(u) => drawEvents(u, of, event)],
        setCursor: [(u) => read(u.cursor.idx ?? null)],
      },
    }
  }

  function drawEvents(u: uPlot, of: Scene, colour: string): void {
    const { ctx, bbox } = u
    ctx.save()
    ctx.strokeStyle = colour
    ctx.setLineDash([4, 4])
    for (const { time: when } of of.header.events) {
      const x = Math.round(u.valToPos(when, 'x', true))
      ctx.beginPath()
      ctx.moveTo(x, bbox.top)
      ctx.lineTo(x, bbox.top + bbox.height)
      ctx.stroke()
    }
    ctx.restore()
  }

  function read(index: number | null): void {
    const { columns } = scene ?? {}
    if (!columns || !now) return
    const shown = index ?? nearest(columns.time, time)
    reading.textContent = `${show(values[shown] ?? null)} ${now.unit}`
  }

  function at(next: number): void {
    time = next
    if (!plot) return
    line.style.transform = `translateX(${plot.valToPos(next, 'x')}px)`
    if (plot.cursor.idx === null || plot.cursor.idx === undefined) read(null)
  }

  const watch = new ResizeObserver(() => {
    if (plot && place.clientWidth > 0) plot.setSize({ width: place.clientWidth, height: plot.height })
    at(time)
  })
  watch.observe(place)
  return {
    element,
    draw,
    at,
    dispose() {
      watch.disconnect()
      plot?.destroy()
    },
  }
}

function nearest(times: Float64Array, time: number): number {
  const last = times.length - 1
  const span = (times[last] ?? 1) - (times[0] ?? 0)
  let index = Math.round(((time - (times[0] ?? 0)) / (span || 1)) * last)
  index = Math.min(last, Math.max(0, index))
  while (index < last && (times[index] ?? 0) < time) index += 1
  while (index > 0 && (times[index] ?? 0) > time) index -= 1
  return index
}

export function createCurves(seek: (time: number) => void): Curves {
  const charts = [createChart('speed', seek), createChart('friction', seek)]
  const element = h(
    'div',
    { class: 'curves' },
    charts.map((chart) => chart.element),
    h('p', { class: 'hint' }, 'Click a curve to go to that instant. Time in s.'),
  )
  let scene: Scene | undefined
  let dirty = false
  let now = 0
  // Told by an observer: to ask the element would have the whole page laid out, at every change.
  let visible = false

  /** Hidden curves wait until they are seen: a slider that is dragged has better things to do. */
  function drawIfSeen(): void {
    if (!scene || !dirty || !visible) return
    dirty = false
    for (const chart of charts) chart.draw(scene)
  }
  const watch = new ResizeObserver(([entry]) => {
    const appears = !visible && entry !== undefined && entry.contentRect.width > 0
    visible = entry !== undefined && entry.contentRect.width > 0
    drawIfSeen()
    if (appears) for (const chart of charts) chart.at(now)
  })
  watch.observe(element)
  return {
    element,
    update(next) {
      scene = next
      dirty = true
      drawIfSeen()
    },
    at(time) {
      now = time
      if (visible) for (const chart of charts) chart.at(time)
    },
    restyle() {
      dirty = true
      drawIfSeen()
    },
    dispose() {
      watch.disconnect()
      for (const chart of charts) chart.dispose()
    },
  }
}

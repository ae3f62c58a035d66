/** Curves: two of them, any quantity over time or against any other; a click goes to that instant. */
import './curves.css'
import { fill, h } from '../lab/dom'
import { show } from '../lab/quantity'
import { baseName, save } from '../lab/saving'
import { put, say } from '../viewer/elements'
import type { Scene } from '../viewer/scene'
import { type Chart, createChart, indexBefore, type Look, type Plot, title } from './chart'
import { type Quantity, quantitiesOf } from './series'

export interface Curves {
  element: HTMLElement
  update(scene: Scene): void
  /** Where the film is: a mark on the curves. */
  at(time: number): void
  /** Theme or size of type have changed. */
  restyle(): void
  dispose(): void
}

/** Say something in passing. */
type Tell = (text: string) => void

interface Figure {
  element: HTMLElement
  draw(scene: Scene): void
  at(time: number): void
  dispose(): void
}

const SAVED = { width: 720, height: 420 } // of a picture that stands alone, px

function lookOf(element: HTMLElement): Look {
  const style = getComputedStyle(element)
  const read = (name: string) => style.getPropertyValue(name).trim()
  return {
    ink: read('--ink-2'),
    grid: read('--line'),
    line: read('--series-1'),
    event: read('--series-2'),
    paper: read('--surface'),
    width: Number(read('--plot-line')) || 1.5,
    font: read('--font-number'),
    size: parseFloat(getComputedStyle(document.documentElement).fontSize) * 0.75,
  }
}

/** The numbers of a plot as a table, every sample a line. */
export function csvOf({ x, y, time }: Plot): string {
  const others = x.values === time ? [y] : [x, y]
  const cell = (value: number | undefined) => (value !== undefined && Number.isFinite(value) ? String(value) : '')
  const heads = ['Time (s)', ...others.map(title)].map((text) => (text.includes(',') ? `"${text}"` : text))
  const rows = Array.from(time, (when, i) => [when, ...others.map(({ values }) => values[i])].map(cell).join(','))
  return `${[heads.join(','), ...rows].join('\n')}\n`
}

/** A plot as an SVG that stands alone, in a file or within a page. */
export function svgOf(plot: Plot, look: Look): string {
  const { element } = createChart(plot, look, SAVED.width, SAVED.height, true)
  element.setAttribute('xmlns', 'http://www.w3.org/2000/svg')
  element.setAttribute('role', 'img')
  put(element, 'aria-label', `${title(plot.y)} over ${title(plot.x)}`)
  return new XMLSerializer().serializeToString(element)
}

async function pngOf(plot: Plot, look: Look): Promise<Blob> {
  const url = URL.createObjectURL(new Blob([svgOf(plot, look)], { type: 'image/svg+xml' }))
  try {
    const picture = new Image()
    picture.src = url
    await picture.decode()
    const canvas = h('canvas', { width: 2 * SAVED.width, height: 2 * SAVED.height })
    canvas.getContext('2d')?.drawImage(picture, 0, 0, canvas.width, canvas.height)
    const blob = await new Promise<Blob | null>((done) => canvas.toBlob(done))
    if (!blob) throw new Error('This browser makes no PNG of a curve. Take the SVG.')
    return blob
  } finally {
    URL.revokeObjectURL(url)
  }
}

function createFigure(tell: Tell, first: string, seek: (time: number) => void): Figure {
  const chosen = { y: first, x: 'time' }
  let scene: Scene | undefined
  let chart: Chart | undefined
  let plot: Plot | undefined
  let time = 0
  let offered = ''
  const choice = (axis: 'x' | 'y', name: string) =>
    h('select', {
      class: 'curve-choice',
      'aria-label': name,
      onchange: (event) => {
        chosen[axis] = (event.currentTarget as HTMLSelectElement).value
        if (scene) draw(scene)
      },
    })
  const [up, across] = [choice('y', 'Quantity of this curve'), choice('x', 'Against what it is drawn')]
  const reading = h('output', { class: 'curve-reading' })
  const place = h('div', { class: 'curve-place', role: 'img' })
  const take = h('select', { class: 'curve-take', 'aria-label': 'Take this curve with you' })
  fill(
    take,
    [
      ['', 'Save …'],
      ['svg', 'SVG'],
      ['png', 'PNG'],
      ['csv', 'CSV'],
      ['embed', 'Copy as HTML'],
    ].map(([value, text]) => h('option', { value: value! }, text)),
  )
  take.addEventListener('change', () => {
    const { value } = take
    take.value = ''
    void taken(value).catch((error: unknown) => tell(error instanceof Error ? error.message : String(error)))
  })
  const element = h(
    'figure',
    { class: 'curve' },
    h('div', { class: 'curve-head' }, up, take),
    place,
    h('div', { class: 'curve-foot' }, h('span', {}, 'over ', across), reading),
  )

  async function taken(format: string): Promise<void> {
    if (!plot || !scene) return
    const name = `${baseName(scene.header.title)}-${chosen.y}-over-${chosen.x}`
    const look = lookOf(element)
    if (format === 'csv') save(new Blob([csvOf(plot)], { type: 'text/csv' }), `${name}.csv`)
    if (format === 'svg') save(new Blob([svgOf(plot, look)], { type: 'image/svg+xml' }), `${name}.svg`)
    if (format === 'png') save(await pngOf(plot, look), `${name}.png`)
    if (format !== 'embed') return
    const caption = h('figcaption', {}, `${scene.header.title}: ${title(plot.y)} over ${title(plot.x)}`).outerHTML
    await navigator.clipboard.writeText(`<figure>${svgOf(plot, look)}${caption}</figure>\n`)
    tell('Copied: HTML that shows this curve in a page of yours.')
  }

  function draw(next: Scene): void {
    scene = next
    const there = quantitiesOf(next)
    offer(there)
    const axis = (id: string, otherwise: string) =>
      there.find((one) => one.id === id) ?? there.find((one) => one.id === otherwise) ?? there[0]!
    const [y, x] = [axis(chosen.y, 'x'), axis(chosen.x, 'time')]
    up.value = y.id
    across.value = x.id
    const told = ({ label, unit, values }: Quantity) => ({ label, unit, values: values() })
    plot = { x: told(x), y: told(y), time: next.columns.time, events: next.header.events.map((event) => event.time) }
    redraw()
    const known = Array.from(plot.y.values).filter(Number.isFinite)
    const [least, most] = [
      known.reduce((a, b) => Math.min(a, b), Infinity),
      known.reduce((a, b) => Math.max(a, b), -Infinity),
    ]
    const over = x.id === 'time' ? 'over time' : `against ${x.label}`
    put(place, 'aria-label', `${y.label} ${over}: from ${show(least)} to ${show(most)} ${y.unit}`)
  }

  /** The lists are filled anew only where others are on offer: an open one stays open. */
  function offer(there: Quantity[]): void {
    const now = there.map((one) => one.id + one.label).join()
    if (now === offered) return
    offered = now
    for (const select of [up, across])
      fill(
        select,
        there.map((one) => h('option', { value: one.id }, one.label)),
      )
  }

  function redraw(): void {
    if (!plot) return
    const look = lookOf(element)
    chart = createChart(plot, look, Math.max(160, place.clientWidth || 300), Math.round(look.size * 14))
    fill(place, chart.element)
    at(time)
  }

  function read(index: number): void {
    if (!plot) return
    const told = ({ values, unit }: Plot['x']) => `${show(values[index])} ${unit}`.trim()
    say(reading, plot.x.values === plot.time ? told(plot.y) : `${told(plot.y)} at ${told(plot.x)}`)
  }

  function at(next: number): void {
    time = next
    if (!plot || !chart) return
    const index = indexBefore(plot.time, next)
    chart.at(index)
    if (!place.matches(':hover')) read(index)
  }

  function under(event: MouseEvent): number | undefined {
    const box = place.getBoundingClientRect()
    return chart?.nearest(event.clientX - box.left, event.clientY - box.top)
  }
  place.addEventListener('pointermove', (event) => {
    const index = under(event)
    if (index !== undefined) read(index)
  })
  place.addEventListener('pointerleave', () => at(time))
  place.addEventListener('click', (event) => {
    const index = under(event)
    if (plot && index !== undefined) seek(plot.time[index]!)
  })

  const watch = new ResizeObserver(() => {
    if (place.clientWidth > 0 && chart && Number(chart.element.getAttribute('width')) !== place.clientWidth) redraw()
  })
  watch.observe(place)
  return { element, draw, at, dispose: () => watch.disconnect() }
}

export function createCurves(tell: Tell, seek: (time: number) => void): Curves {
  const figures = [createFigure(tell, 'speed', seek), createFigure(tell, 'spin_normal', seek)]
  const element = h(
    'div',
    { class: 'curves' },
    figures.map((figure) => figure.element),
    h('p', { class: 'hint' }, 'Click a curve to go to that instant. Dashed lines and rings are events.'),
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
    for (const figure of figures) figure.draw(scene)
  }
  const watch = new ResizeObserver(([entry]) => {
    const appears = !visible && entry !== undefined && entry.contentRect.width > 0
    visible = entry !== undefined && entry.contentRect.width > 0
    drawIfSeen()
    if (appears) for (const figure of figures) figure.at(now)
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
      if (visible) for (const figure of figures) figure.at(time)
    },
    restyle() {
      dirty = true
      drawIfSeen()
    },
    dispose() {
      watch.disconnect()
      for (const figure of figures) figure.dispose()
    },
  }
}

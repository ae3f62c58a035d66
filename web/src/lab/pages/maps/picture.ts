/** The picture of a map: its fields in colours that every eye can tell apart, its sides, its legend, the point on it. */
import { t } from '../../../languages/translate'
import { put, say } from '../../../viewer/elements'
import type { MapPart, MapRequest, Sweeps } from '../../api'
import { fill, h, uniqueId } from '../../dom'
import { show } from '../../quantity'
import { fieldAt, inPrint, labelOf, nameOf, type Side, sideOf, ticksOf } from './axes'

export interface Picture {
  readonly element: HTMLElement
  /** Show a map as far as it is known; the point stays where it is, where the map is of the same shape. */
  draw(part: MapPart, request: MapRequest): void
  /** The point, as fields along the first side and up the second. */
  point(i: number, j: number): void
  readonly at: readonly [number, number] | null
  /** What is written beside it, and heard. */
  readonly said: string
}

const STEPS: Record<string, [number, number]> = {
  ArrowRight: [1, 0],
  ArrowLeft: [-1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
  PageUp: [0, 5],
  PageDown: [0, -5],
}

export function createPicture(colours: Sweeps['colours'], chosen: (i: number, j: number) => void): Picture {
  const id = uniqueId('map')
  const canvas = h('canvas', { class: 'map-canvas', 'aria-hidden': true })
  const cross = h('div', { class: 'map-point', hidden: true })
  const plot = h(
    'div',
    {
      class: 'map-plot',
      tabindex: '0',
      role: 'application',
      'aria-roledescription': 'map',
      'aria-label': 'Map',
      'aria-describedby': id,
      'data-testid': 'map',
    },
    canvas,
    cross,
  )
  const readout = h('p', { class: 'map-readout', id, 'data-testid': 'map-readout' })
  const across = h('div', { class: 'map-ticks map-across', 'aria-hidden': true })
  const up = h('div', { class: 'map-ticks map-up', 'aria-hidden': true })
  const acrossLabel = h('p', { class: 'map-label' })
  const upLabel = h('p', { class: 'map-label map-label-up' })
  const legend = h('div', { class: 'map-legend', 'data-testid': 'map-legend' })
  const element = h(
    'figure',
    { class: 'map' },
    h('div', { class: 'map-frame' }, upLabel, up, plot, across, acrossLabel),
    legend,
    readout,
  )
  let shown: { part: MapPart; sides: [Side, Side]; measure: string; low: number; high: number } | undefined
  let at: [number, number] | null = null

  function colourOf(value: number | null | undefined): string | null {
    if (!shown || value === null || value === undefined) return null
    const { part, low, high } = shown
    if (part.classes.length) return colours.classes[value % colours.classes.length] ?? null
    const share = high > low ? (value - low) / (high - low) : 0.5
    return colours.numbers[Math.round(share * (colours.numbers.length - 1))] ?? null
  }

  function paint(): void {
    if (!shown) return
    const [wide, high] = shown.part.shape
    if (canvas.width !== wide || canvas.height !== high) {
      canvas.width = wide
      canvas.height = high
    }
    const context = canvas.getContext('2d')
    if (!context) return
    context.clearRect(0, 0, wide, high)
    shown.part.picture.forEach((value, place) => {
      const colour = colourOf(value)
      if (!colour) return
      context.fillStyle = colour
      context.fillRect(Math.floor(place / high), high - 1 - (place % high), 1, 1)
    })
  }

  function ticks(host: HTMLElement, side: Side, most: number, way: 'left' | 'bottom'): void {
    fill(
      host,
      ticksOf(side, most).map(({ at: where, text }) => {
        const tick = h('span', {}, text)
        tick.style[way] = `${100 * where}%`
        return tick
      }),
    )
  }

  function drawLegend(): void {
    if (!shown) return
    const { part, measure, low, high } = shown
    const known = new Set(part.picture)
    const none = known.has(null) ? [swatch('no value', null)] : []
    const title = h('span', { class: 'map-legend-title' }, labelOf(measure, part.unit))
    if (part.classes.length) {
      const swatches = part.classes.map((word, value) => (known.has(value) ? swatch(word, colourOf(value)) : null))
      fill(legend, title, swatches, none)
      return
    }
    const bar = h('canvas', { class: 'map-bar', width: colours.numbers.length, height: 1, 'aria-hidden': true })
    const context = bar.getContext('2d')
    colours.numbers.forEach((shade, i) => {
      if (!context) return
      context.fillStyle = shade
      context.fillRect(i, 0, 1, 1)
    })
    const ends = Number.isFinite(low) ? [h('span', {}, show(low)), bar, h('span', {}, show(high))] : []
    fill(legend, title, h('span', { class: 'map-scale' }, ends), none)
  }

  function swatch(word: string, colour: string | null): HTMLElement {
    const patch = h('span', { class: 'map-swatch', 'data-none': colour === null })
    if (colour) patch.style.background = colour
    return h('span', { class: 'map-key' }, patch, word)
  }

  function said(): string {
    if (!shown) return ''
    if (!at) return 'Click on the map, or go over it with the arrow keys: the run of that point plays.'
    const { part, sides, measure } = shown
    const where = sides.map((side, i) => `${nameOf(side)} = ${show(side.values[at![i]!])} ${inPrint(side.unit)}`.trim())
    const value = part.picture[at[0] * part.shape[1] + at[1]]
    const word =
      value === null || value === undefined
        ? 'no value'
        : (part.classes[value] ?? `${show(value)} ${part.unit === '1' ? '' : inPrint(part.unit)}`.trim())
    return `${where.join(', ')}: ${measure} ${part.classes.length || word === 'no value' ? '' : '= '}${word}`
  }

  function mark(): void {
    cross.hidden = at === null
    if (at && shown) {
      const [wide, high] = shown.part.shape
      cross.style.left = `${(100 * at[0]) / wide}%`
      cross.style.bottom = `${(100 * at[1]) / high}%`
      cross.style.width = `${100 / wide}%`
      cross.style.height = `${100 / high}%`
    }
    say(readout, said())
  }

  function choose(i: number, j: number): void {
    if (!shown || (at && at[0] === i && at[1] === j)) return
    at = [i, j]
    mark()
    chosen(i, j)
  }

  function pointed(event: PointerEvent): void {
    if (!shown) return
    const box = plot.getBoundingClientRect()
    choose(
      fieldAt(shown.sides[0], (event.clientX - box.left) / box.width),
      fieldAt(shown.sides[1], (box.bottom - event.clientY) / box.height),
    )
  }
  plot.addEventListener('pointerdown', (event) => {
    plot.setPointerCapture(event.pointerId)
    pointed(event)
  })
  plot.addEventListener('pointermove', (event) => {
    if (plot.hasPointerCapture(event.pointerId)) pointed(event)
  })
  plot.addEventListener('keydown', (event) => {
    if (!shown || event.ctrlKey || event.metaKey || event.altKey) return
    const [wide, high] = shown.part.shape
    const [i, j] = at ?? [Math.floor(wide / 2), Math.floor(high / 2)]
    const step = event.key === 'Home' ? [-wide, 0] : event.key === 'End' ? [wide, 0] : STEPS[event.key]
    if (!step) return
    event.preventDefault()
    const within = (value: number, most: number) => Math.max(0, Math.min(most - 1, value))
    if (at) choose(within(i + step[0]!, wide), within(j + step[1]!, high))
    else choose(i, j)
  })

  return {
    element,
    draw(part, request) {
      const sides: [Side, Side] = [sideOf(part.axes[0]!, request.over[0]), sideOf(part.axes[1]!, request.over[1])]
      const values = part.picture.filter((value) => value !== null)
      const [low, high] = values.reduce<[number, number]>(
        ([least, most], value) => [Math.min(least, value), Math.max(most, value)],
        [Infinity, -Infinity],
      )
      if (at && (at[0] >= part.shape[0] || at[1] >= part.shape[1])) at = null
      shown = { part, sides, measure: request.measure, low, high }
      const named = [acrossLabel, upLabel].map((label, i) => {
        const { key, unit } = sides[i]!
        const name = nameOf(sides[i]!)
        say(label, labelOf(name, unit))
        put(label, 'title', key)
        return name
      })
      const [first = '', second = ''] = named
      put(
        plot,
        'aria-label',
        t('Map of {measure} over {first} and {second}', { measure: request.measure, first, second }),
      )
      ticks(across, sides[0], 6, 'left')
      ticks(up, sides[1], 7, 'bottom')
      paint()
      drawLegend()
      mark()
    },
    point(i, j) {
      at = [i, j]
      mark()
    },
    get at() {
      return at
    },
    get said() {
      return said()
    },
  }
}

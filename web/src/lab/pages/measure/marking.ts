/** A picture of a film on which places and colours are taken: by pointer, or by a cross that arrow keys move. */
import { t } from '../../../languages/translate'
import { put, say } from '../../../viewer/elements'
import { h, uniqueId } from '../../dom'

export type Pixel = readonly [number, number]

export interface Marking {
  readonly element: HTMLElement
  /** Show a picture, of a film so many pixels wide. */
  show(picture: ImageBitmap, width: number): void
  /** Draw what is known already: the rim, places that were marked, each with its number. */
  draw(rim: readonly Pixel[], marks: readonly Pixel[]): void
  paint(): void
}

const FAR = 10 // px of the film, with Shift
const NEAR = 2 // px of the picture to either side, of which the colour is taken

export function createMarking(taken: (at: Pixel, colour: string) => void): Marking {
  const canvas = h('canvas', { class: 'film-picture', width: 4, height: 3 })
  const id = uniqueId('cross')
  const said = h('output', { id, class: 'film-cross number', 'data-testid': 'film-cross' })
  const frame = h(
    'div',
    {
      class: 'film-frame',
      tabindex: 0,
      role: 'application',
      'aria-label': 'Picture of the film: arrow keys move a cross, Enter takes what is under it',
      'aria-describedby': id,
      'data-testid': 'film-picture',
    },
    canvas,
  )
  let picture: ImageBitmap | null = null
  let scale = 1 // px of the film a px of the picture
  let cross: Pixel | null = null
  let rim: readonly Pixel[] = []
  let marks: readonly Pixel[] = []

  /** Of the film to the canvas: the middle of the first pixel is 0. */
  const place = ([x, y]: Pixel): [number, number] => [(x + 0.5) / scale, (y + 0.5) / scale]
  const within = (value: number, most: number) => Math.max(0, Math.min(most - 1, value))

  function paint(): void {
    const context = canvas.getContext('2d', { willReadFrequently: true })
    if (!context || !picture) return
    context.drawImage(picture, 0, 0)
    const wide = Math.max(1, canvas.width / 320)
    for (const [shade, width] of [
      ['#000000', 3 * wide],
      ['#56b4e9', 1.5 * wide],
    ] as const) {
      context.lineWidth = width
      context.strokeStyle = shade
      if (rim.length) {
        context.beginPath()
        for (const point of rim) context.lineTo(...place(point))
        context.closePath()
        context.stroke()
      }
      for (const mark of marks) tick(context, place(mark), 5 * wide)
      if (cross) tick(context, place(cross), 9 * wide)
    }
    context.font = `bold ${12 * wide}px sans-serif`
    marks.forEach((mark, i) => {
      const [x, y] = place(mark)
      context.lineWidth = 3 * wide
      context.strokeStyle = '#000000'
      context.fillStyle = '#ffffff'
      context.strokeText(String(i + 1), x + 6 * wide, y - 6 * wide)
      context.fillText(String(i + 1), x + 6 * wide, y - 6 * wide)
    })
  }

  /** The median of each part of the colour about a place, the drawings left out. */
  function colourAt(at: Pixel): string {
    if (!picture) return '#000000'
    const side = 2 * NEAR + 1
    const [x, y] = place(at).map(Math.floor) as [number, number]
    const bare = new OffscreenCanvas(side, side).getContext('2d')
    if (!bare) return '#000000'
    const [left, top] = [within(x, canvas.width) - NEAR, within(y, canvas.height) - NEAR]
    bare.drawImage(picture, left, top, side, side, 0, 0, side, side)
    const { data } = bare.getImageData(0, 0, side, side)
    const part = (offset: number) =>
      [...data].filter((_, i) => i % 4 === offset && data[i - offset + 3]! > 0).sort((a, b) => a - b)
    const hex = [0, 1, 2].map((offset) => {
      const sorted = part(offset)
      return (sorted[sorted.length >> 1] ?? 0).toString(16).padStart(2, '0')
    })
    return `#${hex.join('')}`
  }

  function move(to: Pixel): void {
    cross = [within(to[0], canvas.width * scale), within(to[1], canvas.height * scale)]
    say(said, t('{x} px to the right, {y} px down, colour {colour}', told(cross)))
    paint()
  }

  const told = (at: Pixel) => ({ x: at[0].toFixed(0), y: at[1].toFixed(0), colour: colourAt(at) })

  frame.addEventListener('pointerdown', (event) => {
    if (!picture || event.button !== 0) return
    const box = canvas.getBoundingClientRect()
    const share = [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height] as const
    const at: Pixel = [share[0] * canvas.width * scale - 0.5, share[1] * canvas.height * scale - 0.5]
    move(at)
    taken(cross!, colourAt(cross!))
  })
  frame.addEventListener('keydown', (event) => {
    if (!picture) return
    const step = event.shiftKey ? FAR : 1
    const [x, y] = cross ?? [(canvas.width * scale) / 2, (canvas.height * scale) / 2]
    const steps: Record<string, Pixel> = {
      ArrowLeft: [x - step, y],
      ArrowRight: [x + step, y],
      ArrowUp: [x, y - step],
      ArrowDown: [x, y + step],
    }
    const to = steps[event.key]
    if (to) move(to)
    else if (event.key === 'Enter' || event.key === ' ') {
      move([x, y])
      taken(cross!, colourAt(cross!))
    } else return
    event.preventDefault()
    event.stopPropagation()
  })

  return {
    element: h('div', { class: 'film-marking' }, frame, said),
    show(next, width) {
      picture?.close()
      picture = next
      canvas.width = next.width
      canvas.height = next.height
      scale = width / next.width
      put(frame, 'data-shown', `${next.width}x${next.height}`)
      paint()
    },
    draw(nextRim, nextMarks) {
      rim = nextRim
      marks = nextMarks
      paint()
    },
    paint,
  }
}

function tick(context: CanvasRenderingContext2D, [x, y]: [number, number], size: number): void {
  context.beginPath()
  for (const [across, up] of [
    [size, 0],
    [0, size],
  ] as const) {
    context.moveTo(x - across, y - up)
    context.lineTo(x - across / 3, y - up / 3)
    context.moveTo(x + across / 3, y + up / 3)
    context.lineTo(x + across, y + up)
  }
  context.stroke()
}

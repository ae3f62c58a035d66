/** The film, played with the ball drawn in: where it was seen, and where the fit has it. */
import { t } from '../../../languages/translate'
import { put, say } from '../../../viewer/elements'
import { type Api, type Followed, isAbort, type KeptFilm, type Outlines, type TrackColumns } from '../../api'
import { fill, h, svg, uniqueId } from '../../dom'

export interface Showing {
  readonly element: HTMLElement
  /** Show a film with the ball as it was followed; null takes it away. */
  show(shown: { file: File; film: KeptFilm; followed: Followed; columns: TrackColumns } | null): void
  /** Draw the fitted ball; null takes it away. */
  fitted(seen: Outlines | null): void
  dispose(): void
}

type Point = readonly [number, number]

const TRAIL = 60 // places
const STEPS = 1000
const PLAY = 'M6.5 4.2v11.6L16 10z'
const PAUSE = 'M6.5 4.5v11M13.5 4.5v11'

/** The two rows about a time, and how far it is from the first to the second; null outside. */
export function between(times: readonly (number | null)[], time: number): [number, number, number] | null {
  const last = times.length - 1
  if (last < 0 || !(time >= times[0]! - 1e-9) || !(time <= times[last]! + 1e-9)) return null
  let [low, high] = [0, last]
  while (high - low > 1) {
    const middle = (low + high) >> 1
    if (times[middle]! <= time) low = middle
    else high = middle
  }
  const apart = times[high]! - times[low]!
  return [low, high, apart > 0 ? Math.max(0, Math.min(1, (time - times[low]!) / apart)) : 0]
}

const mixed = ([a, b]: Point, [c, d]: Point, share: number): Point => [a + (c - a) * share, b + (d - b) * share]

/** The fitted outline at a time. */
export function outlineAt(seen: Outlines, time: number): Point[] | null {
  const at = between(seen.time, time)
  if (!at) return null
  const [low, high, share] = at
  return seen.outlines[low]!.map((point, i) => mixed(point, seen.outlines[high]![i]!, share))
}

export function middleOf(outline: readonly Point[]): Point {
  const sum = outline.reduce<Point>(([a, b], [x, y]) => [a + x, b + y], [0, 0])
  return [sum[0] / outline.length, sum[1] / outline.length]
}

export function createShowing(api: Api): Showing {
  const video = h('video', { playsinline: true, preload: 'auto', tabindex: -1, 'aria-hidden': true })
  video.muted = true
  const still = h('img', { alt: '', hidden: true })
  const canvas = h('canvas', { class: 'film-drawn', role: 'img', 'aria-label': 'The film with the ball drawn in' })
  const id = uniqueId('film-time')
  const press = h('button', { type: 'button', class: 'transport-play', 'data-testid': 'film-play' })
  const range = h('input', {
    id,
    class: 'slider',
    type: 'range',
    min: 0,
    max: STEPS,
    step: 1,
    value: 0,
    'aria-label': 'Time of the film',
    'data-testid': 'film-time',
  })
  const clock = h('output', { for: id, class: 'transport-clock' })
  const said = h('p', { class: 'map-hint', role: 'status', 'data-testid': 'film-apart' })
  const note = h('p', { class: 'map-hint', hidden: true, 'data-testid': 'film-note' })
  const legend = h('p', { class: 'film-legend' })
  const view = h('div', { class: 'film-view' }, video, still, canvas)
  const element = h(
    'figure',
    { class: 'film-showing', hidden: true, 'data-testid': 'film-showing' },
    view,
    h(
      'div',
      { class: 'transport', role: 'group', 'aria-label': 'Playback of the film' },
      press,
      range,
      clock,
      h('span', {}),
    ),
    legend,
    said,
    note,
  )

  let shown: Parameters<Showing['show']>[0] = null
  let seen: Outlines | null = null
  let address = ''
  let time = 0 // of the film, s
  let playing = false
  let frame = 0
  let began = { at: 0, time: 0 } // of the pictures' own clock
  let pictures: { time: number; image: HTMLImageElement }[] | null = null // of a film that is not played here
  let fetching: AbortController | null = null

  const length = () => shown?.film.length || video.duration || 1

  function leave(): void {
    cancelAnimationFrame(frame)
    playing = false
    fetching?.abort()
    pictures = null
    video.pause()
    video.removeAttribute('src')
    video.load()
    if (address) URL.revokeObjectURL(address)
    address = ''
  }

  function show(next: typeof shown): void {
    leave()
    shown = next
    seen = null
    element.hidden = next === null
    note.hidden = true
    video.hidden = false
    still.hidden = true
    if (!next) return
    view.style.aspectRatio = `${next.film.width} / ${next.film.height}`
    canvas.width = next.film.width
    canvas.height = next.film.height
    address = URL.createObjectURL(next.file)
    video.src = address
    time = 0
    pressed()
    refresh()
  }

  /** The browser cannot play it: pictures of the lab stand for it. */
  async function playPictures(): Promise<void> {
    if (!shown || pictures) return
    const mine = new AbortController()
    fetching = mine
    pictures = []
    video.hidden = true
    still.hidden = false
    note.hidden = false
    say(note, 'This browser cannot play the film: the lab sends pictures of it.')
    try {
      for (let from: number | null = 0; from !== null && pictures && shown; ) {
        const reel = await api.filmReel(shown.film.film, shown.film.length, from, { lane: null, signal: mine.signal })
        for (const [i, at] of reel.times.entries()) {
          const image = new Image()
          image.src = reel.pictures[i]!
          pictures.push({ time: at, image })
        }
        from = reel.next
        refresh()
      }
      if (!mine.signal.aborted)
        say(
          note,
          t('This browser cannot play the film: {count} pictures of it stand for it.', {
            count: String(pictures?.length ?? 0),
          }),
        )
    } catch (error) {
      if (!isAbort(error)) say(note, error instanceof Error ? error.message : String(error))
    }
  }

  video.addEventListener('error', () => address && void playPictures())
  video.addEventListener('loadeddata', () => (video.videoWidth === 0 ? void playPictures() : refresh()))
  video.addEventListener('seeked', () => refresh())
  video.addEventListener('ended', () => {
    playing = false
    pressed()
  })

  function tick(): void {
    if (!playing) return
    if (pictures) {
      time = began.time + (performance.now() - began.at) / 1e3
      if (time >= length()) {
        time = length()
        playing = false
        pressed()
      }
    } else time = video.currentTime
    refresh()
    frame = requestAnimationFrame(tick)
  }

  press.addEventListener('click', () => {
    playing = !playing
    if (playing && time >= length() - 0.05) time = 0
    if (playing && pictures) began = { at: performance.now(), time }
    if (!pictures && playing) {
      if (video.currentTime !== time) video.currentTime = time
      void video.play()
    } else if (!pictures) video.pause()
    pressed()
    cancelAnimationFrame(frame)
    if (playing) frame = requestAnimationFrame(tick)
    else refresh()
  })
  range.addEventListener('input', () => {
    if (playing) press.click()
    time = (Number(range.value) / STEPS) * length()
    if (!pictures) video.currentTime = time
    refresh()
  })

  function pressed(): void {
    const path = svg('path', { d: playing ? PAUSE : PLAY })
    fill(press, svg('svg', { viewBox: '0 0 20 20', 'aria-hidden': 'true' }, path))
    put(press, 'aria-label', playing ? 'Pause the film' : 'Play the film')
    press.classList.toggle('playing', playing)
  }

  function refresh(): void {
    if (!shown) return
    if (pictures?.length) {
      const since = pictures.filter((one) => one.time <= time + 1e-6)
      const { src } = (since.at(-1) ?? pictures[0]!).image
      if (still.src !== src) still.src = src
    }
    const { followed, columns } = shown
    const now = time / followed.slow
    const times = columns.t ?? []
    const at = between(times, now)
    const measured = at && mixed(followed.pixels[at[0]]!, followed.pixels[at[1]]!, at[2])
    const outline = seen && outlineAt(seen, now)
    range.value = String(Math.round((time / length()) * STEPS))
    range.style.setProperty('--to', `${(100 * time) / length()}%`)
    say(clock, `${time.toFixed(1)} s`)
    const apart = measured && outline ? distance(measured, middleOf(outline)) : null
    const words = apart === null ? '' : t('Fitted and measured are {apart} px apart.', { apart: apart.toFixed(1) })
    put(range, 'aria-valuetext', `${time.toFixed(1)} s. ${words}`)
    if (!playing) say(said, words)
    draw(at ? followed.pixels.slice(Math.max(0, at[0] - TRAIL), at[0] + 1) : [], measured, outline)
  }

  function draw(trail: readonly Point[], measured: Point | null, outline: readonly Point[] | null): void {
    const context = canvas.getContext('2d')
    if (!context) return
    context.clearRect(0, 0, canvas.width, canvas.height)
    const wide = Math.max(1, canvas.width / 480)
    const line = (points: readonly Point[], shade: string, width: number, closed = false) => {
      context.beginPath()
      for (const [x, y] of points) context.lineTo(x + 0.5, y + 0.5)
      if (closed) context.closePath()
      for (const [under, stroke] of [
        [width + 1.5, '#000000'],
        [width, shade],
      ] as const) {
        context.lineWidth = under * wide
        context.strokeStyle = stroke
        context.stroke()
      }
    }
    if (trail.length > 1) line(trail, MEASURED, 1)
    if (outline) line(outline, FITTED, 1.5, true)
    if (measured) {
      const [x, y] = measured
      const arm = 5 * wide
      line(
        [
          [x - arm, y],
          [x + arm, y],
        ],
        MEASURED,
        1.2,
      )
      line(
        [
          [x, y - arm],
          [x, y + arm],
        ],
        MEASURED,
        1.2,
      )
    }
    const key = (shade: string, words: string) => {
      const sample = h('span', { class: 'film-key', 'aria-hidden': true })
      sample.style.background = shade
      return h('span', {}, sample, words)
    }
    if (legend.childElementCount !== (seen ? 2 : 1))
      fill(legend, key(MEASURED, 'where the ball was seen'), seen ? key(FITTED, 'the fitted ball') : null)
  }

  return {
    element,
    show,
    fitted(next) {
      seen = next
      refresh()
    },
    dispose: leave,
  }
}

const MEASURED = '#f0e442'
const FITTED = '#56b4e9'
const distance = ([a, b]: Point, [c, d]: Point) => Math.hypot(a - c, b - d)

/** A film: kept by the lab, its first picture shown, what is in it told, and the ball followed through it. */
import { shownDigits, t, typedDigits } from '../../../languages/translate'
import { handOver, put, say } from '../../../viewer/elements'
import { type Api, ApiError, type FilmBounds, isAbort, type KeptFilm, type Track } from '../../api'
import { cleanup, fill, h, uniqueId } from '../../dom'
import type { Json } from '../../scenario'
import { button, choice, slider } from '../parts/controls'
import { createMarking, type Pixel } from './marking'

/** A film is known by its name: some systems do not say its type. */
export const isFilm = (file: File): boolean =>
  file.type.startsWith('video/') || /\.(mp4|mov|m4v|avi|webm|mkv|mpe?g|mts|3gp|wmv|ogv)$/i.test(file.name)

export interface FilmPanel {
  readonly element: HTMLElement
  /** Take a film, or none: the one before is forgotten. */
  take(file: File | null): Promise<void>
  dispose(): void
}

export interface FilmPanelOptions {
  api: Api
  /** The ball was followed. */
  followed(track: Track, file: File, film: KeptFilm): void
  wrong(error: unknown): void
}

interface Field {
  key: string
  label: string
  hint: string
  /** A bare number, and not a text with a unit. */
  bare?: boolean
}

const RIM: Field = { key: 'rim_radius', label: 'Radius of the rim', hint: '15 cm' }
const BALL: Field = { key: 'ball_radius', label: 'Radius of the ball', hint: '20 mm' }
const COLOURS: readonly Field[] = [
  { key: 'mark_colour', label: 'Colour of the dot on the table', hint: 'there is none' },
  { key: 'colour', label: 'Colour of the ball', hint: 'is found' },
]
const MORE: readonly Field[] = [
  { key: 'frame_rate', label: 'Pictures taken a second, of slow motion', hint: 'as it is played', bare: true },
  { key: 'table_rate', label: 'Rate of the table, to check the film by', hint: '33.3 rpm' },
  { key: 'height', label: 'Height of the lens over the table', hint: 'is found' },
  { key: 'begin', label: 'Begin at', hint: '0 s' },
  { key: 'end', label: 'End at', hint: 'the end' },
  { key: 'distortion', label: 'Distortion of the lens', hint: '0', bare: true },
  { key: 'readout', label: 'Time from the first row of the sensor to the last', hint: '0 s' },
]
const FEWEST = 4 // marks
const ASKING = 400 // ms between two questions how far it is
type Taking = 'mark_colour' | 'colour' | 'marks'

interface Mark {
  at: Pixel
  x: string
  y: string
}

export function createFilm({ api, followed, wrong }: FilmPanelOptions): FilmPanel {
  const undo = cleanup()
  let working: AbortController | null = null
  let file: File | null = null
  let film: KeptFilm | null = null
  let marks: Mark[] = []
  const inputs = new Map<string, HTMLInputElement>()

  const about = h('p', { class: 'film-about', role: 'status', 'data-testid': 'film-about' })
  const rimSaid = h('p', { class: 'map-hint' })
  const marking = createMarking(take)
  const at = slider({
    label: 'Picture at',
    min: 0,
    max: 1,
    step: 0.01,
    value: 0,
    words: (share) => `${((film?.length ?? 0) * share).toFixed(2)} s`,
    change: () => void look(),
    testid: 'film-at',
  })
  const taking = choice<Taking>(
    'A click on the picture, or Enter, takes',
    [
      ['mark_colour', 'the dot’s colour'],
      ['colour', 'the ball’s colour'],
      ['marks', 'a mark’s place'],
    ],
    'mark_colour',
    () => {},
  )
  const list = h('ol', { class: 'film-marks' })
  const rimField = field(RIM)
  const marked = h(
    'div',
    { hidden: true },
    h('p', { class: 'map-hint' }, 'Take at least four marks at the table’s height, far apart, and say where they are.'),
    list,
  )
  const by = choice<'rim' | 'marks'>(
    'The camera is calibrated by',
    [
      ['rim', 'the table’s whole rim'],
      ['marks', 'four marks'],
    ],
    'rim',
    (how) => {
      rimField.hidden = how !== 'rim'
      marked.hidden = how === 'rim'
      taking.set(how === 'marks' ? 'marks' : 'mark_colour')
      redraw()
    },
  )
  const go = button('Follow the ball', () => void follow(), 'primary', 'film-follow')
  const stop = button('Stop', () => working?.abort(), 'plain', 'film-stop')
  stop.hidden = true
  const bar = h('progress', { max: 1, value: 0, 'aria-label': 'How much of the film has been followed', hidden: true })
  const panel = h(
    'div',
    { class: 'film-panel', hidden: true },
    marking.element,
    at.element,
    taking.element,
    h('div', { class: 'film-fields' }, field(BALL)),
    by.element,
    rimField,
    rimSaid,
    marked,
    h('div', { class: 'film-fields' }, COLOURS.map(field)),
    h(
      'p',
      { class: 'map-hint' },
      'A dot on the table tells how fast it turns, and from which side the camera looks. Click on it in the picture.',
    ),
    h(
      'details',
      {},
      h('summary', {}, 'Slow motion, and more about the film'),
      h('div', { class: 'measure-fields' }, MORE.map(field)),
    ),
    h('div', { class: 'buttons film-go' }, go, stop, bar),
  )
  const element = h('div', { class: 'film', role: 'group', 'aria-label': 'The film' }, about, panel)

  function field({ key, label, hint }: Field): HTMLElement {
    const id = uniqueId('film')
    const input = h('input', {
      id,
      type: 'text',
      placeholder: hint,
      autocomplete: 'off',
      spellcheck: 'false',
      'data-testid': `film-${key}`,
    })
    inputs.set(key, input)
    const swatch = key.endsWith('colour') ? h('span', { class: 'film-swatch', 'aria-hidden': true }) : null
    if (swatch) {
      const tint = () => {
        swatch.style.background = CSS.supports('color', input.value) ? input.value : 'transparent'
      }
      input.addEventListener('input', tint)
      input.addEventListener('change', tint)
    }
    return h('div', { class: 'map-field' }, h('label', { for: id }, label), h('span', {}, input, swatch))
  }

  /** Something of the picture was chosen. */
  function take(place: Pixel, colour: string): void {
    if (taking.value === 'marks') {
      marks = [...marks, { at: place, x: '', y: '' }]
      listMarks()
      list.querySelector<HTMLInputElement>('li:last-child input')?.focus({ preventScroll: true })
      return
    }
    const input = inputs.get(taking.value)!
    input.value = colour
    input.dispatchEvent(new Event('change'))
  }

  function listMarks(): void {
    fill(
      list,
      marks.map((mark, i) => {
        const box = (axis: 'x' | 'y') =>
          h('input', {
            type: 'text',
            value: shownDigits(mark[axis]),
            placeholder: axis === 'x' ? '10 cm' : '0 cm',
            'aria-label': t('{axis} of mark {number}', { axis, number: String(i + 1) }),
            oninput: (event) => {
              mark[axis] = typedDigits((event.target as HTMLInputElement).value)
            },
          })
        const away = button('Remove', () => {
          marks = marks.filter((one) => one !== mark)
          listMarks()
        })
        put(away, 'aria-label', t('Remove mark {number}', { number: String(i + 1) }))
        const seen = `${mark.at[0].toFixed(1)}, ${mark.at[1].toFixed(1)} px`
        return h('li', {}, h('span', { class: 'number' }, seen), box('x'), box('y'), away)
      }),
    )
    redraw()
  }

  function redraw(): void {
    const rim = by.value === 'rim' ? (film?.rim ?? []) : []
    marking.draw(rim, by.value === 'marks' ? marks.map((one) => one.at) : [])
    say(
      rimSaid,
      by.value !== 'rim' || !film
        ? ''
        : film.rim
          ? 'The rim is where the line is drawn.'
          : 'No rim is found in the first picture. It may be found in the film: else take four marks.',
    )
  }

  async function look(): Promise<void> {
    if (!film) return
    try {
      const picture = await api.filmPicture(film.film, Number(at.input.value) * film.length)
      marking.show(await createImageBitmap(picture), film.width)
    } catch (error) {
      if (!isAbort(error)) wrong(error)
    }
  }

  function forget(): void {
    working?.abort()
    if (film) api.dropFilm(film.film)
    film = null
    file = null
    panel.hidden = true
    fill(about)
  }

  async function takeFilm(next: File | null): Promise<void> {
    forget()
    if (!next) return
    file = next
    wrong(null)
    const mine = new AbortController()
    working = mine
    try {
      const bounds = await api.filmBounds({ signal: mine.signal })
      if (next.size > bounds.bytes) throw tooLarge(next, bounds)
      say(about, t('Sending the film {title} …', { title: next.name }))
      film = await api.keepFilm(next, next.name, { lane: null, signal: mine.signal })
      marks = []
      at.set(0)
      at.input.step = String(Math.min(0.1, Math.max(1e-4, 1 / (film.length * film.rate || 100))))
      fill(about, h('strong', {}, next.name), ': ', aboutOf(film))
      const rate = inputs.get('frame_rate')!
      rate.value = film.taken !== null && Math.abs(film.taken / film.rate - 1) > 0.05 ? String(film.taken) : ''
      if (rate.value) rate.closest('details')!.open = true
      panel.hidden = false
      listMarks()
      await look()
    } catch (error) {
      if (mine.signal.aborted) return
      fill(about)
      if (!isAbort(error)) wrong(error)
    } finally {
      if (working === mine) working = null
    }
  }

  function told(): { [key: string]: Json } {
    const said: { [key: string]: Json } = {}
    for (const { key, bare } of [BALL, ...(by.value === 'rim' ? [RIM] : []), ...COLOURS, ...MORE]) {
      const text = typedDigits(inputs.get(key)!.value).trim()
      if (text) said[key] = bare ? numberOf(text, key) : text
    }
    if (by.value === 'marks')
      said.marks = marks.map(({ at: [x, y], x: there, y: up }) => [x, y, there || '0', up || '0'])
    return said
  }

  function check(): void {
    const missing = [BALL, ...(by.value === 'rim' ? [RIM] : [])].find(({ key }) => !inputs.get(key)!.value.trim())
    if (missing) throw new ApiError(t('{label}: say how large it is.', { label: t(missing.label) }), missing.key, '', 0)
    if (by.value === 'marks' && marks.length < FEWEST)
      throw new ApiError('Take at least four marks on the picture.', 'marks', '', 0)
    if (by.value === 'marks' && marks.some(({ x, y }) => !x.trim() || !y.trim()))
      throw new ApiError('Say of each mark where it is: x and y, such as 10 cm and 0 cm.', 'marks', '', 0)
  }

  async function follow(): Promise<void> {
    if (!film || !file) return
    const [kept, of] = [film, file]
    for (const input of inputs.values()) input.removeAttribute('aria-invalid')
    wrong(null)
    const mine = new AbortController()
    working = mine
    let asking: ReturnType<typeof setInterval> | undefined
    try {
      check()
      const asked = told()
      busy(true)
      asking = setInterval(() => void ask(kept, mine.signal), ASKING)
      followed(await api.followFilm(kept.film, asked, { lane: null, signal: mine.signal }), of, kept)
    } catch (error) {
      if (!isAbort(error) && !mine.signal.aborted) {
        wrong(inWords(error))
        if (error instanceof ApiError && error.key) point(error.key)
      }
    } finally {
      clearInterval(asking)
      busy(false)
      if (working === mine) working = null
    }
  }

  async function ask(kept: KeptFilm, signal: AbortSignal): Promise<void> {
    try {
      const { done } = await api.filmProgress(kept.film, { lane: null, signal })
      bar.value = done
      say(go, t('Following the ball: {percent} %', { percent: String(Math.floor(100 * done)) }))
    } catch {
      // what is wrong is told by who follows
    }
  }

  function busy(now: boolean): void {
    if (now) stop.hidden = false
    else go.disabled = false
    handOver(now ? go : stop, now ? stop : go)
    go.disabled = now
    stop.hidden = !now
    bar.hidden = !now
    bar.value = 0
    say(go, now ? 'Following the ball …' : 'Follow the ball')
  }

  /** Show which box is meant. */
  function point(key: string): void {
    const input = inputs.get(key.replace(/\[.*/, ''))
    if (!input) return
    input.setAttribute('aria-invalid', 'true')
    const more = input.closest('details')
    if (more) more.open = true
    input.focus()
  }

  undo.add(forget)
  return { element, take: takeFilm, dispose: () => undo.run() }
}

/** What the package calls by the names of its options is called here as the boxes are. */
function inWords(error: unknown): unknown {
  if (!(error instanceof ApiError)) return error
  const called = new Map([RIM, BALL, ...COLOURS, ...MORE].map(({ key, label }) => [`\`${key}\``, `“${t(label)}”`]))
  called.set('`marks`', `“${t('four marks')}”`)
  let { message } = error
  for (const [key, label] of called) message = message.replaceAll(key, label)
  return new ApiError(message, error.key, error.kind, error.status)
}

function numberOf(text: string, key: string): number {
  const number = Number(text)
  if (!Number.isFinite(number)) throw new ApiError(t('{text} is no number.', { text: `“${text}”` }), key, '', 0)
  return number
}

function aboutOf({ width, height, rate, length }: KeptFilm): string {
  const said = { size: `${width} × ${height}`, rate: String(Math.round(100 * rate) / 100), length: length.toFixed(1) }
  return t('{size} pixels, {rate} pictures a second, {length} s.', said)
}

function tooLarge(file: File, bounds: FilmBounds): ApiError {
  const mib = (bytes: number) => (bytes / 2 ** 20).toFixed(0)
  const said = t('The film has {size} MiB; the lab takes {most} MiB. Cut it, or use trundle track.', {
    size: mib(file.size),
    most: mib(bounds.bytes),
  })
  return new ApiError(said, 'file', '', 413)
}

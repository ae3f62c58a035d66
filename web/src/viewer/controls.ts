/** The viewer's own bar: play, scrub, speed, whose eyes, which arrows. Everything can be reached by keyboard. */
import { t } from '../languages/translate'
import { ARROWS, type ArrowKind } from './arrows'
import type { Frame, Show, Viewer } from './contract'
import { element, hide, icon, iconButton, put, say } from './elements'
import { FRAME_NAMES, FRAMES, framesOf } from './frames'
import { nextSpeed, SPEEDS } from './player'
import { shortNumber } from './quantities'
import type { Scene, SceneEvent } from './scene'

const FLASHES = [0, 1, 2, 5, 10, 20, 50, 100] as const
const SLIDER_STEPS = 10_000

const SWITCHES: readonly { show: keyof Show; symbol: string; name: string }[] = [
  { show: 'velocity', symbol: 'V', name: 'Velocity' },
  { show: 'contactForce', symbol: 'R', name: 'Contact force' },
  { show: 'angularVelocity', symbol: 'Ω', name: 'Angular velocity' },
  { show: 'gravity', symbol: 'mg', name: 'Weight, mg' },
  { show: 'frictionCone', symbol: 'Cone', name: 'Friction cone' },
  { show: 'guidingCentre', symbol: 'Centre', name: 'Guiding centre' },
  { show: 'trail', symbol: 'Path', name: 'Path' },
  { show: 'axes', symbol: 'Axes', name: 'Axes of the frame' },
]

export class Controls {
  readonly element: HTMLElement
  private readonly playing: HTMLButtonElement
  private readonly slider: HTMLInputElement
  private readonly clock: HTMLElement
  private readonly total: HTMLElement
  private readonly ticks: HTMLElement
  private readonly marks: HTMLElement[] = []
  private readonly speed: HTMLSelectElement
  private readonly looping: HTMLButtonElement
  private readonly flashes = element('select', 'tr-speed tr-flashes', {
    'aria-label': 'Stroboscope',
    title: 'Stroboscope: flashes in a second of the run, each of which leaves a faint picture',
  })
  private readonly following: HTMLButtonElement
  private readonly sounding: HTMLButtonElement
  private readonly frames = new Map<Frame, HTMLButtonElement>()
  private readonly switches = new Map<keyof Show, HTMLButtonElement>()
  private places = 2
  private readonly segments = element('div', 'tr-segments', { role: 'group', 'aria-label': 'Whose eyes (F)' })

  constructor(private readonly viewer: Viewer) {
    this.playing = iconButton('play', 'Play (space)', () => (viewer.playing ? viewer.pause() : viewer.play()))
    this.playing.classList.add('tr-play')
    this.slider = element('input', 'tr-slider', {
      type: 'range',
      min: '0',
      max: String(SLIDER_STEPS),
      step: '1',
      value: '0',
      'aria-label': 'Time',
    })
    this.slider.addEventListener('input', () =>
      viewer.seek(this.begin + (Number(this.slider.value) / SLIDER_STEPS) * viewer.duration),
    )
    this.clock = element('output', 'tr-clock')
    this.total = element('span', 'tr-total')
    this.ticks = element('div', 'tr-ticks', { 'aria-hidden': 'true' })
    this.speed = this.speeds()
    this.flashes.addEventListener('change', () => {
      viewer.flashes = Number(this.flashes.value)
    })
    for (const rate of FLASHES)
      this.flashes.append(element('option', '', { value: String(rate) }, rate ? `✦${rate}` : '✦'))
    this.looping = this.toggle('loop', 'Repeat (L)', () => (viewer.loop = !viewer.loop))
    this.following = this.toggle('follow', 'Camera goes with the body (B)', () => (viewer.follow = !viewer.follow))
    this.sounding = this.toggle('sound', 'Sound (U)', () => (viewer.sound = !viewer.sound))
    this.element = element(
      'div',
      'tr-controls',
      { role: 'group', 'aria-label': 'Playback and view' },
      this.timeRow(),
      this.viewRow(),
    )
  }

  private begin = 0

  private timeRow(): HTMLElement {
    const { viewer } = this
    const track = element('div', 'tr-track', {}, this.slider, this.ticks)
    return element(
      'div',
      'tr-row tr-time',
      {},
      this.playing,
      iconButton('back', 'One sample back (←)', () => viewer.step(-1)),
      iconButton('forward', 'One sample on (→)', () => viewer.step(1)),
      track,
      element('div', 'tr-reading', {}, this.clock, this.total),
      this.speed,
      this.flashes,
      this.looping,
    )
  }

  private viewRow(): HTMLElement {
    const { viewer } = this
    const frames = this.segments
    for (const frame of FRAMES) {
      const { short, long } = FRAME_NAMES[frame]
      const button = element('button', 'tr-segment', { type: 'button', title: long, 'aria-pressed': 'false' }, short)
      button.addEventListener('click', () => (viewer.frame = frame))
      this.frames.set(frame, button)
      frames.append(button)
    }
    const arrows = element('div', 'tr-switches', { role: 'group', 'aria-label': 'Shown on the stage' })
    for (const { show, symbol, name } of SWITCHES) {
      const arrow = show in ARROWS
      const label = element('span', arrow ? 'tr-symbol' : '', {}, symbol)
      const button = element(
        'button',
        'tr-switch',
        { type: 'button', title: name, 'aria-label': name, 'aria-pressed': 'false' },
        label,
      )
      if (arrow) button.dataset.arrow = show as ArrowKind
      button.addEventListener('click', () => (viewer.show = { [show]: !viewer.show[show] }))
      this.switches.set(show, button)
      arrows.append(button)
    }
    const camera = element(
      'div',
      'tr-camera',
      { role: 'group', 'aria-label': 'Camera' },
      iconButton('home', 'Camera back to its place (C)', () => viewer.resetCamera()),
      iconButton('top', 'From above (T)', () => viewer.topView()),
      this.following,
      this.sounding,
    )
    return element('div', 'tr-row tr-view', {}, frames, arrows, camera)
  }

  private speeds(): HTMLSelectElement {
    const select = element('select', 'tr-speed', { 'aria-label': 'Speed', title: 'Speed ([ and ])' })
    for (const speed of SPEEDS) select.append(element('option', '', { value: String(speed) }, `${shortNumber(speed)}×`))
    select.addEventListener('change', () => {
      this.viewer.speed = Number(select.value)
    })
    return select
  }

  private toggle(name: 'loop' | 'follow' | 'sound', label: string, pressed: () => void): HTMLButtonElement {
    const button = iconButton(name, label, pressed)
    button.setAttribute('aria-pressed', 'false')
    return button
  }

  /** What the scenes have to offer: a frame that rides only where something turns, a cone only where there is friction. */
  setScenes(scenes: readonly Scene[], begin: number): void {
    this.begin = begin
    const { duration } = this.viewer
    this.places = duration < 0.5 ? 4 : duration < 20 ? 2 : 1
    say(this.total, `/ ${shortNumber(duration)} s`)
    const headers = scenes.map(({ header }) => header)
    const offered = framesOf(scenes)
    for (const [frame, button] of this.frames) hide(button, !offered.includes(frame))
    hide(this.segments, offered.length < 2)
    hide(this.switches.get('frictionCone')!, !headers.some(({ support }) => support.friction !== null))
    hide(this.switches.get('guidingCentre')!, !scenes.some(({ columns }) => columns.guiding_centre))
    hide(this.switches.get('contactForce')!, !scenes.some(({ columns }) => columns.contact_force))
    this.mark(headers.flatMap(({ events }) => events ?? []))
  }

  private mark(events: readonly SceneEvent[]): void {
    const shown = events.slice(0, 60)
    while (this.marks.length > shown.length) this.marks.pop()!.remove()
    shown.forEach(({ time, text }, i) => {
      const tick = this.marks[i] ?? this.ticks.appendChild(element('span', 'tr-tick'))
      this.marks[i] = tick
      put(tick, 'title', text)
      tick.style.left = `${(100 * (time - this.begin)) / (this.viewer.duration || 1)}%`
    })
  }

  update(): void {
    const { viewer } = this
    const passed = viewer.time - this.begin
    const value = String(Math.round((passed / (viewer.duration || 1)) * SLIDER_STEPS))
    if (this.slider.value !== value) this.slider.value = value
    this.slider.style.setProperty('--tr-share', `${(100 * passed) / (viewer.duration || 1)}%`)
    const clock = `${viewer.time.toFixed(this.places)} s`
    say(this.clock, clock)
    put(this.slider, 'aria-valuetext', `${viewer.time.toFixed(this.places)} seconds`)
  }

  /** After anything else has changed: buttons show what is so. */
  refresh(): void {
    const { viewer } = this
    const label = viewer.playing ? 'Pause (space)' : 'Play (space)'
    if (this.playing.title !== t(label)) {
      put(this.playing, 'aria-label', label)
      put(this.playing, 'title', label)
      this.playing.replaceChildren(icon(viewer.playing ? 'pause' : 'play'))
    }
    put(this.looping, 'aria-pressed', String(viewer.loop))
    put(this.following, 'aria-pressed', String(viewer.follow))
    put(this.sounding, 'aria-pressed', String(viewer.sound))
    for (const [frame, button] of this.frames) put(button, 'aria-pressed', String(viewer.frame === frame))
    for (const [show, button] of this.switches) put(button, 'aria-pressed', String(viewer.show[show]))
    const known = SPEEDS.some((speed) => speed === viewer.speed)
    if (known) this.speed.value = String(viewer.speed)
    this.flashes.value = String(viewer.flashes)
    this.update()
  }
}

/** Keys that work while the viewer has the focus; tells whether it was one of them. */
export function pressed(
  viewer: Viewer,
  key: string,
  shift: boolean,
  ends: { begin: number; nextFrame(): void },
): boolean {
  const leap = 0.05 * viewer.duration
  const keys: Record<string, () => void> = {
    ' ': () => (viewer.playing ? viewer.pause() : viewer.play()),
    k: () => (viewer.playing ? viewer.pause() : viewer.play()),
    ArrowLeft: () => (shift ? viewer.seek(viewer.time - leap) : viewer.step(-1)),
    ArrowRight: () => (shift ? viewer.seek(viewer.time + leap) : viewer.step(1)),
    Home: () => viewer.seek(ends.begin),
    End: () => viewer.seek(ends.begin + viewer.duration),
    '[': () => (viewer.speed = nextSpeed(viewer.speed, -1)),
    ']': () => (viewer.speed = nextSpeed(viewer.speed, 1)),
    l: () => (viewer.loop = !viewer.loop),
    f: () => ends.nextFrame(),
    c: () => viewer.resetCamera(),
    t: () => viewer.topView(),
    b: () => (viewer.follow = !viewer.follow),
    u: () => (viewer.sound = !viewer.sound),
  }
  SWITCHES.forEach(({ show }, i) => {
    keys[String(i + 1)] = () => (viewer.show = { [show]: !viewer.show[show] })
  })
  const act = keys[key.length === 1 ? key.toLowerCase() : key]
  act?.()
  return act !== undefined
}

/** The stage: the viewer, its tools, what is written over it, and what is done on it by hand. */
import type { Place } from '../../viewer/contract'
import { put as attribute, hide, say } from '../../viewer/elements'
import { beside, capital } from '../../viewer/headline'
import { WORDS } from '../../viewer/narration'
import { printed } from '../../viewer/printing'
import type { Scene, Triple } from '../../viewer/scene'
import type { Tool, Viewer } from '../../viewer/viewer'
import { createViewer } from '../../viewer/viewer'
import { type Instant, isAbort, type StartRequest } from '../api'
import type { App } from '../app'
import { cleanup, fill, h } from '../dom'
import { type IconName, icon } from '../icons'
import { changing } from '../math'
import { show } from '../quantity'
import { createRunner } from '../runner'
import type { Change } from '../store'
import { instantAt, sampleAt } from './instant'
import { goneOn, put, whyNotDragged, whyNotNudged } from './placing'

/** "0.42 ms", "1.3 s". */
function duration(seconds: number): string {
  return seconds < 1 ? `${show(1000 * seconds, 2)} ms` : `${show(seconds, 2)} s`
}

type BenchTool = Exclude<Tool, 'draw'>

const AGAIN = 1500 // ms: an arrow key pressed later begins from what is there then
const THROWN = 0.02 // m/s that an arrow key adds
const NUDGED = 0.05 // m/s by which an arrow key nudges
const SOON = 250 // ms: an answer that comes sooner needs no sign that one works at it, which would only flicker

const TOOLS: {
  tool: BenchTool
  icon: IconName
  word: string
  label: string
  key: string
  hint(body: string): string
}[] = [
  {
    tool: 'orbit',
    icon: 'orbit',
    word: 'View',
    label: 'Turn the view',
    key: 'O',
    hint: (body) => `Take ${body} and let it go, or throw it. Drag beside it to turn the view.`,
  },
  {
    tool: 'drag',
    icon: 'hand',
    word: 'Move',
    label: 'Move it',
    key: 'D',
    hint: (body) => `Drag ${body} to where it should start, or move it by the arrow keys. Enter lets it go.`,
  },
  {
    tool: 'velocity',
    icon: 'arrow',
    word: 'Throw',
    label: 'Draw its velocity',
    key: 'V',
    hint: (body) => `Drag from ${body}: the arrow is the first velocity. Arrow keys change it, Enter throws.`,
  },
  {
    tool: 'nudge',
    icon: 'nudge',
    word: 'Nudge',
    label: 'Nudge it',
    key: 'N',
    hint: (body) => `Drag from ${body} while it runs, or press an arrow key: it goes on from there.`,
  },
]

export interface Stage {
  element: HTMLElement
  viewer: Viewer
  setScene(scene: Scene, keep: { camera: boolean; time: boolean; rests: boolean }): void
  working(busy: boolean): void
  /** How long computing it took, and how long it was under way altogether. */
  took(milliseconds: number, scene: Scene): void
  /** What is drawn is not what is asked for: why, or null where it is. */
  stale(why: string | null): void
  useTool(tool: BenchTool): void
  dispose(): void
}

/** A direction of the support frame, laid along the surface where a body touches it. */
function tangent([x, y]: [number, number], { position, contact }: Instant): Triple {
  const up = position.map((part, axis) => part - contact[axis]!) as Triple
  const size = Math.hypot(...up) || 1
  const [nx, ny, nz] = up.map((part) => part / size) as Triple
  const off = x * nx + y * ny
  const along: Triple = [x - off * nx, y - off * ny, -off * nz]
  const length = Math.hypot(...along)
  return length > 1e-6 ? (along.map((part) => part / length) as Triple) : [0, 0, 1]
}

export function createStage(app: App): Stage {
  const undo = cleanup()
  const { store } = app
  const host = h('div', { class: 'stage-canvas' })
  const hint = h('p', { class: 'stage-hint', role: 'status', hidden: true })
  const time = h('p', { class: 'stage-took' })
  const big = h('div', { class: 'stage-headline', hidden: true })
  const law = changing()
  const old = h('p', { class: 'stage-stale', hidden: true }, 'The last path that could be computed')
  const empty = h('p', { class: 'stage-empty working' }, 'Computing the motion …')
  const tools = h('div', { class: 'stage-tools', role: 'radiogroup', 'aria-label': 'What the pointer does' })
  const element = h('section', { class: 'stage', 'aria-label': 'Stage' }, host, empty, tools, big, time, old)
  const viewer = createViewer(host, { theme: app.appearance, controls: true, projector: app.settings.projector })
  host.querySelector('.tr-stage')?.append(hint)
  let scene: Scene | undefined
  let hasStarted = false
  let released = false
  let knowsHand = false // whoever has taken the ball once needs no word about it
  let late: ReturnType<typeof setTimeout> | undefined

  const buttons = TOOLS.map(({ tool, icon: name, word, label, key }) => {
    const button = h('button', {
      class: 'tool',
      type: 'button',
      role: 'radio',
      title: `${label} (${key})`,
      'aria-label': label,
      'data-tool': tool,
    })
    button.append(icon(name), h('span', { class: 'tool-word' }, word))
    button.addEventListener('click', () => useTool(tool))
    return button
  })
  fill(tools, buttons)
  tools.addEventListener('keydown', (event) => {
    const way = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key]
    if (way === undefined) return
    event.preventDefault()
    event.stopPropagation()
    const at = TOOLS.findIndex((one) => one.tool === viewer.tool)
    const next = (at + way + TOOLS.length) % TOOLS.length
    useTool(TOOLS[next]!.tool)
    buttons[next]?.focus()
  })

  function useTool(tool: BenchTool): void {
    const why =
      tool === 'nudge' ? whyNotNudged(store.scenario, scene) : tool === 'orbit' ? null : whyNotDragged(store.scenario)
    if (why) {
      app.toast(why)
      return
    }
    viewer.tool = tool
    buttons.forEach((button, index) => {
      const on = TOOLS[index]?.tool === tool
      button.setAttribute('aria-checked', String(on))
      button.tabIndex = on ? 0 : -1
    })
    sayHint()
    hint.hidden = tool === 'orbit' && (knowsHand || whyNotDragged(store.scenario) !== null)
    if (tool === 'drag' || tool === 'velocity') {
      viewer.pause()
      viewer.seek(0)
    }
  }
  /** In the words of what lies there. */
  function sayHint(): void {
    const chosen = TOOLS.find(({ tool }) => tool === viewer.tool)
    say(hint, chosen?.hint(`the ${scene?.header.body.noun ?? WORDS.body}`) ?? '')
  }
  useTool('orbit')

  /** What is done by hand: the package says which start that is. */
  const starts = createRunner<{ by: StartRequest[]; change: Change; done?: string; go?: boolean }, () => void>({
    async run({ by, change, done, go }, signal) {
      const before = store.scenario
      const asked = by.map((one) => app.api.start(before, one, { signal, lane: null }))
      const [parts, ...found] = await Promise.all([app.parts(), ...asked])
      return () => {
        const start = Object.assign({}, ...found)
        released = go ?? false
        store.set(by[0]?.nudge ? goneOn(before, start) : put(store.scenario, start, parts), change)
        if (done) app.toast(done)
      }
    },
    done: (apply) => apply(),
    failed: (error, { by, go }) => {
      // While it is dragged there is no need to say that it cannot lie just there.
      if ((by[0]?.nudge || go) && !isAbort(error)) app.toast(error instanceof Error ? error.message : String(error))
    },
  })

  let gestures = 0
  undo.add(
    viewer.on('dragstart', () => {
      gestures += 1
      if (viewer.tool !== 'orbit') return
      knowsHand = hint.hidden = true
      viewer.pause()
      viewer.seek(0)
    }),
    viewer.on('drag', (place) => drag(place, null)),
    viewer.on('dragend', ({ velocity, ...place }) => drag(place, velocity, viewer.tool === 'orbit')),
    viewer.on('arrow', ({ vx, vy, vz, done }) => {
      if (!scene) return
      const { position, contact } = instantAt(scene, viewer.time)
      const by: StartRequest = { at: { position, contact }, velocity: [vx, vy, vz] }
      starts.ask({ by: [by], change: { source: 'drag', gesture: `arrow${gestures}` } })
      if (done) gestures += 1
    }),
    viewer.on('nudge', ({ vx, vy, vz, time: when, done }) => {
      if (done) nudge([vx, vy, vz], when)
    }),
    () => starts.stop(),
  )

  /** The body is put down there, or thrown from there; `go`: it was let go, and the film begins. */
  function drag({ x, y, z, contact }: Place, velocity: Triple | null, go = false): void {
    const at: StartRequest['at'] = { position: [x, y, z], contact }
    const by: StartRequest[] = velocity ? [{ at }, { at, velocity }] : [{ at }]
    starts.ask({ by, go, change: { source: 'drag', gesture: `drag${gestures}` } })
  }

  function nudge(by: Triple, when: number): void {
    if (!scene) return
    const at = sampleAt(scene, when)
    const done = `Nudged at ${show(at.time, 3)} s by ${show(Math.hypot(...by), 2)} m/s: this is the new start.`
    starts.ask({ by: [{ at, nudge: by }], change: { source: 'nudge', restarts: true }, done })
  }

  /** What the arrow keys have made of the start, or of the velocity, since they were pressed first. */
  let moving: { at: StartRequest['at']; velocity: Triple; pressed: number } | null = null

  /** By the keyboard: the arrows move the start, or change its velocity, or nudge; Enter lets it go. */
  function press(event: KeyboardEvent): void {
    const { tool } = viewer
    const own = !(event.target as Element).matches('[data-testid="stage"]')
    if (own || tool === 'orbit' || tool === 'draw' || !scene || event.ctrlKey || event.metaKey || event.altKey) return
    const way = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key]
    if (event.key === 'Enter' && tool !== 'nudge') {
      viewer.seek(0)
      viewer.play()
    } else if (way) moveBy(scene, tool, way as [number, number], event.shiftKey ? 5 : 1, performance.now())
    else return
    event.preventDefault()
    event.stopPropagation()
  }

  function moveBy(of: Scene, tool: BenchTool, way: [number, number], times: number, now: number): void {
    const begin = of.columns.time[0] ?? 0
    const here = instantAt(of, tool === 'nudge' ? viewer.time : begin)
    const along = tangent(way, here)
    if (tool === 'nudge') {
      nudge(along.map((part) => part * NUDGED * times) as Triple, viewer.time)
      return
    }
    if (!moving || now - moving.pressed > AGAIN) {
      moving = { at: { position: here.position, contact: here.contact }, velocity: here.velocity, pressed: now }
      gestures += 1
    }
    moving.pressed = now
    const plus = (one: Triple, by: number) => one.map((part, axis) => part + by * along[axis]!) as Triple
    const change: Change = { source: 'drag', gesture: `keys${gestures}` }
    if (tool === 'velocity') {
      moving.velocity = plus(moving.velocity, THROWN * times)
      app.announce(
        `Velocity ${moving.velocity
          .slice(0, 2)
          .map((part) => show(100 * part, 3))
          .join(', ')} cm/s`,
      )
      starts.ask({ by: [{ at: moving.at, velocity: moving.velocity }], change })
      return
    }
    // On what is hollow or round no further than the body reaches: the surface is looked for near there.
    const step = of.header.body.radius * (of.header.support.flat ? 0.2 * times : Math.min(0.2 * times, 0.4))
    const { position, contact } = moving.at
    moving.at = { position: plus(position, step), contact: plus(contact, step) }
    app.announce(
      `Start ${moving.at.contact
        .slice(0, 2)
        .map((part) => show(100 * part, 3))
        .join(', ')} cm`,
    )
    starts.ask({ by: [{ at: moving.at }], change })
  }
  element.addEventListener('keydown', press, { capture: true })

  /** While it stands still the whole path is there; while it runs the body draws it. */
  function drawAhead(): void {
    viewer.show.ahead = !viewer.playing
  }
  undo.add(viewer.on('play', drawAhead), viewer.on('pause', drawAhead))

  function drawHeadline(of: Scene): void {
    const { headline, formula, method } = of.header
    const said = method === 'exact' ? formula?.latex : undefined // the law itself is too long
    fill(
      big,
      headline && h('p', { class: 'headline-text' }, capital(headline.text)),
      headline?.other && h('p', { class: 'headline-other' }, beside(headline)),
      said && law.element,
    )
    if (said) law.set(said)
    hide(big, !headline && !said)
  }

  undo.add(
    app.watchSettings((settings) => {
      viewer.theme = app.appearance
      viewer.projector = settings.projector
    }),
    printed(host, viewer),
    () => viewer.dispose(),
  )
  return {
    element,
    viewer,
    useTool,
    setScene(next, keep) {
      const first = scene === undefined
      scene = next
      sayHint()
      hide(empty, true)
      const was = viewer.playing
      drawAhead()
      viewer.setScenes([next], { keepTime: !first && keep.time, keepCamera: !first && keep.camera, rests: keep.rests })
      element.dataset.shown = next.header.title // for tests: a title changes before its path is there
      viewer.grabs = whyNotDragged(store.scenario) === null
      if (released) viewer.seek(0)
      if ((was || (released && !app.settings.reducedMotion)) && !viewer.playing) viewer.play()
      released = false
      drawHeadline(next)
      if (!hasStarted && !app.settings.reducedMotion && viewer.tool === 'orbit') viewer.play()
      hasStarted = true
    },
    working(busy) {
      element.toggleAttribute('data-busy', busy)
      element.removeAttribute('data-late')
      clearTimeout(late)
      if (busy) late = setTimeout(() => element.setAttribute('data-late', ''), SOON)
    },
    took(milliseconds, { header }) {
      const method =
        { exact: 'closed form', taylor: 'Taylor series', 'runge-kutta': 'Runge–Kutta' }[header.method] ?? header.method
      const whole = duration(milliseconds / 1000)
      const computed = typeof header.seconds === 'number' ? duration(header.seconds) : null
      fill(time, h('span', { class: 'number' }, computed ?? whole), ` ${method}`)
      const finely = header.tolerance > 1e-12 ? `, to ${show(header.tolerance, 1)} a step while the numbers move` : ''
      const asked = `From the question to the picture: ${whole}.`
      attribute(time, 'title', computed ? `Computed in ${computed}${finely}. ${asked}` : asked)
    },
    stale(why) {
      hide(old, why === null || scene === undefined)
      element.toggleAttribute('data-stale', why !== null)
      if (scene || why === null) return
      empty.classList.remove('working')
      say(empty, why)
    },
    dispose() {
      clearTimeout(late)
      undo.run()
    },
  }
}

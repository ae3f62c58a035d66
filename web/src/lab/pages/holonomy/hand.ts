/** Roll the ball by quarter turns or drag it along, and watch its north pole. */
import { say } from '../../../viewer/elements'
import type { Scene } from '../../../viewer/scene'
import type { App } from '../../app'
import { cleanup, fill, h, listen } from '../../dom'
import { show as written } from '../../quantity'
import { createRunner } from '../../runner'
import { isTyping } from '../../shell'
import { button } from '../parts/controls'
import { createNumbers, type Row } from '../parts/numbers'
import { paragraph } from '../parts/prose'
import { createStage, FROM_ABOVE } from '../parts/stage'
import { createPoleMap } from './pole'
import { componentsOf, degrees, directionInWords, poleWhile, RADIUS, type Rolled, roll, rolledOf } from './rolling'
import { type Piece, type Place, piecesOf, TURN_NAMES, type Turn } from './turns'

/** Nearer points of a drag are not worth a piece of path, m. */
const GRAIN = 0.002
/** The server rolls along no more. */
const MOST_PIECES = 500
const SECONDS_A_PIECE = 0.7
/** Of what the camera takes in at the start, m; beyond it the view is set anew. */
const IN_VIEW = 5 * RADIUS
/** A way to either side: what the camera is set by before anything has been rolled. */
const ABOUT: readonly Turn[] = ['E', 'E', 'W', 'W', 'N', 'N', 'S', 'S', 'W', 'W', 'E', 'E', 'S', 'S']
const KEYS: Readonly<Record<string, Turn>> = { ArrowRight: 'E', ArrowUp: 'N', ArrowLeft: 'W', ArrowDown: 'S' }

export function mountHand(host: HTMLElement, app: App): () => void {
  const undo = cleanup()
  const stage = createStage(app, {
    label: 'A ball with its north pole marked, on a level plane',
    controls: false,
    poles: true,
    from: FROM_ABOVE,
  })
  const { viewer } = stage
  const pole = createPoleMap()
  const numbers = createNumbers('Turned since the start')
  const place = h('p', { class: 'where', 'data-testid': 'where' })
  undo.add(() => stage.dispose())

  let pieces: Piece[] = []
  let scene: Scene | null = null
  let at: Place = [0, 0]
  let framed = false
  let warned = false
  /** Where the last drag point lies, which may not have been answered yet. */
  let reached: Place = [0, 0]

  interface Asked {
    pieces: Piece[]
    from: 'turn' | 'drag'
  }
  const live = createRunner<Asked, Scene>({
    run: (asked, signal) => roll(app, asked.pieces, { signal }),
    done: (found, { from }) => shown(found, from),
    failed: (error) => stage.problem(error),
    patience: 400,
  })
  undo.add(() => live.stop())

  function shown(found: Scene, from: 'turn' | 'drag'): void {
    const stages = rolledOf(found).stages
    const before = stages[stages.length - 2]?.time ?? 0
    const inside = framed && Math.hypot(...reached) < IN_VIEW
    scene = found
    stage.problem(null)
    viewer.setScenes([found], { keepCamera: inside })
    framed = inside
    viewer.loop = false
    // The server sets the pace by the whole way; the last piece shall take the same time however long that is.
    viewer.speed = (viewer.duration - before) / SECONDS_A_PIECE
    if (from === 'drag' || app.settings.reducedMotion) viewer.seek(viewer.duration)
    else {
      viewer.seek(before)
      viewer.play()
    }
    told()
  }

  function told(): void {
    if (!scene) return
    const rolled = rolledOf(scene)
    const last = rolled.stages[rolled.stages.length - 1]
    at = last ? [last.position[0], last.position[1]] : [0, 0]
    const home = rolled.closed && pieces.length > 0
    say(place, home ? 'Home again.' : `${inRadii(at[0])} east, ${inRadii(at[1])} north of home, in radii.`)
    place.classList.toggle('home', home)
    numbers.set([
      { name: 'turned since the start', predicted: null, measured: degrees(rolled.turned) },
      rolled.turned > 1e-6
        ? { name: 'about the axis (east, north, up)', predicted: null, measured: componentsOf(rolled.turned_axis) }
        : undefined,
      ...(home ? areaRows(rolled) : []),
    ])
    app.announce(`North pole ${directionInWords(rolled.north_pole)}. ${place.textContent}`)
  }

  function full(): boolean {
    if (pieces.length < MOST_PIECES) return false
    if (!warned) app.toast('That is a long way already. Start again for another.')
    warned = true
    return true
  }

  function turn(which: Turn): void {
    if (full()) return
    pieces = [...pieces, ...piecesOf([which])]
    const way = { E: [1, 0], N: [0, 1], W: [-1, 0], S: [0, -1] }[which]
    reached = [reached[0] + way[0]! * RADIUS * (Math.PI / 2), reached[1] + way[1]! * RADIUS * (Math.PI / 2)]
    live.ask({ pieces, from: 'turn' })
  }

  function drag(x: number, y: number): void {
    if (Math.hypot(x - reached[0], y - reached[1]) < GRAIN || full()) return
    reached = [x, y]
    pieces = [...pieces, { kind: 'straight', to: [x, y] }]
    live.ask({ pieces, from: 'drag' })
  }

  function homeward(): void {
    if (Math.hypot(...reached) < 1e-9 || full()) return
    reached = [0, 0]
    pieces = [...pieces, { kind: 'straight', to: [0, 0] }]
    live.ask({ pieces, from: 'turn' })
  }

  /** A ball that has not rolled yet: a way that is not taken, shown at its beginning. */
  async function restart(): Promise<void> {
    live.stop()
    pieces = []
    warned = false
    at = reached = [0, 0]
    scene = null
    try {
      const found = await roll(app, piecesOf(ABOUT), { samples: 200 })
      if (pieces.length) return
      viewer.setScenes([found])
      viewer.pause()
      viewer.seek(0)
      viewer.tool = 'drag'
      framed = true
      pole.set([0, 0, 1])
      say(place, 'At home, north pole up.')
      place.classList.remove('home')
      numbers.set([])
    } catch (error) {
      stage.problem(error)
    }
  }

  undo.add(
    viewer.on('time', () => {
      if (scene) pole.set(poleWhile(scene, viewer.time))
    }),
    viewer.on('drag', ({ x, y }) => drag(x, y)),
    listen(
      window,
      'keydown',
      (event: KeyboardEvent) => {
        const which = KEYS[event.key]
        if (!which || isTyping(event) || event.ctrlKey || event.metaKey || event.altKey || event.shiftKey) return
        if (document.querySelector('dialog[open]')) return
        event.preventDefault()
        event.stopPropagation()
        turn(which)
      },
      { capture: true },
    ),
  )

  fill(host, layout(stage.element, pad(turn), homeward, restart, pole.element, place, numbers.element))
  void restart()
  return () => undo.run()
}

function pad(turn: (which: Turn) => void): HTMLElement {
  const one = (which: Turn, arrow: string) =>
    h(
      'button',
      {
        type: 'button',
        class: `button pad-${which}`,
        'aria-label': `${which}, a quarter turn ${TURN_NAMES[which]}`,
        'data-testid': `roll-${which}`,
        onclick: () => turn(which),
      },
      h('span', { 'aria-hidden': 'true' }, arrow),
      which,
    )
  return h(
    'div',
    { class: 'pad', role: 'group', 'aria-label': 'Quarter turns; the arrow keys do the same' },
    one('N', '↑'),
    one('W', '←'),
    one('E', '→'),
    one('S', '↓'),
  )
}

function layout(
  stage: HTMLElement,
  keys: HTMLElement,
  homeward: () => void,
  restart: () => Promise<void>,
  pole: HTMLElement,
  place: HTMLElement,
  numbers: HTMLElement,
): HTMLElement {
  return h(
    'div',
    { class: 'lesson spread' },
    h(
      'div',
      { class: 'spread-text' },
      h('p', { class: 'kicker' }, 'Rolling remembers'),
      h('h1', {}, 'Where is its pole now?'),
      paragraph(
        'Roll the ball by quarter turns, with the buttons or the arrow keys, or drag it along the plane. It never slips and never pivots. Bring it home, and look at its pole.',
      ),
      h('div', { class: 'hand' }, keys, pole),
      h(
        'div',
        { class: 'buttons' },
        button('Straight home', homeward, 'plain', 'straight-home'),
        button('Start again', () => void restart(), 'quiet', 'start-again'),
      ),
    ),
    h('div', { class: 'spread-stage' }, stage, place, numbers),
  )
}

function inRadii(length: number): string {
  return written(Number((length / RADIUS).toFixed(3))) ?? '0'
}

/** The rule for small loops is set beside the angle only where the loop is small. */
function areaRows({ enclosed_area, small_loop, small_loop_angle, turned_about_normal }: Rolled): Row[] {
  if (enclosed_area === null || small_loop_angle === null) return []
  const area: Row = {
    name: 'area enclosed, anticlockwise',
    symbol: 'A/a^2',
    predicted: null,
    measured: Number((enclosed_area / RADIUS ** 2).toFixed(6)) + 0,
  }
  if (!small_loop) return [area]
  const turned = degrees(turned_about_normal)
  return [
    area,
    { name: 'turned about the vertical', symbol: '-A/a^2', predicted: degrees(small_loop_angle), measured: turned },
  ]
}

/** Home by a circle or a square: the angle turned, beside the area enclosed. */
import type { Scene } from '../../../viewer/scene'
import type { App } from '../../app'
import { cleanup, fill, h } from '../../dom'
import { formula } from '../../math'
import { createRunner } from '../../runner'
import { button, choice, slider } from '../parts/controls'
import { createNumbers } from '../parts/numbers'
import { paragraph } from '../parts/prose'
import { createStage, FROM_ABOVE } from '../parts/stage'
import { createAngles } from './angles'
import { createPoleMap } from './pole'
import { degrees, poleWhile, RADIUS, roll, rolledOf } from './rolling'
import { loop, type Shape } from './turns'

/** In radii of the ball. */
const LARGEST: Readonly<Record<Shape, number>> = { circle: 1, square: 1.8 }

interface Wanted {
  shape: Shape
  size: number
  left: boolean
}

export function mountLoop(host: HTMLElement, app: App): () => void {
  const undo = cleanup()
  const stage = createStage(app, {
    label: 'A ball rolled once round a loop, home again',
    poles: true,
    from: FROM_ABOVE,
  })
  const { viewer } = stage
  const pole = createPoleMap()
  const numbers = createNumbers('The angle turned, and the area enclosed')
  const angles = createAngles()
  undo.add(() => stage.dispose())
  let wanted: Wanted = { shape: 'circle', size: 0.4, left: true }
  let scene: Scene | null = null

  const live = createRunner<Wanted, Scene>({
    run: ({ shape, size, left }, signal) => roll(app, loop(shape, size * RADIUS, left), { signal }),
    done(found, asked) {
      const first = scene === null
      scene = found
      stage.problem(null)
      viewer.setScenes([found], { keepCamera: !first })
      viewer.loop = false
      viewer.speed = 2
      viewer.seek(viewer.duration)
      told(asked)
    },
    failed: (error) => stage.problem(error),
  })
  undo.add(() => live.stop())

  function told({ shape }: Wanted): void {
    if (!scene) return
    const { turned, enclosed_area, small_loop_angle, turned_axis } = rolledOf(scene)
    const area = Math.abs(enclosed_area ?? 0)
    angles.add(shape, area / RADIUS ** 2, turned)
    numbers.set([
      { name: 'area enclosed', symbol: 'A', predicted: null, measured: area * 1e4, unit: 'cm²' },
      {
        name: 'angle turned',
        symbol: 'A/a^2',
        predicted: degrees(Math.abs(small_loop_angle ?? 0)),
        measured: degrees(turned),
      },
      {
        name: 'axis off the vertical',
        predicted: null,
        measured: degrees(Math.acos(Math.min(1, Math.abs(turned_axis[2]))), 1),
      },
    ])
  }

  const size = slider({
    label: 'Size',
    min: 0.05,
    max: 1,
    step: 0.05,
    value: wanted.size,
    words: (share) => `${share.toFixed(2)} ${wanted.shape === 'circle' ? 'a, radius' : 'a, side'}`,
    change: (share) => ask({ size: share }),
    testid: 'loop-size',
  })
  const shape = choice(
    'Loop',
    [
      ['circle', 'Circle'],
      ['square', 'Square'],
    ] as const,
    'circle',
    (value) => {
      size.input.max = String(LARGEST[value])
      wanted = { ...wanted, shape: value, size: Math.min(wanted.size, LARGEST[value]) }
      size.set(wanted.size)
      ask({})
    },
  )
  const sense = choice(
    'Round',
    [
      ['left', 'Anticlockwise'],
      ['right', 'Clockwise'],
    ] as const,
    'left',
    (value) => ask({ left: value === 'left' }),
  )

  function ask(part: Partial<Wanted>): void {
    wanted = { ...wanted, ...part }
    live.ask(wanted)
  }

  function rollIt(): void {
    viewer.seek(0)
    if (app.settings.reducedMotion) viewer.seek(viewer.duration)
    else viewer.play()
  }

  undo.add(viewer.on('time', () => scene && pole.set(poleWhile(scene, viewer.time))))
  fill(
    host,
    h(
      'div',
      { class: 'lesson spread' },
      h(
        'div',
        { class: 'spread-text' },
        h('p', { class: 'kicker' }, 'Home, and turned'),
        h('h1', {}, 'A loop leaves its area behind'),
        paragraph(
          'Roll the ball once round, back to where it began. Nobody twisted it, and yet it has turned, against the sense of the loop: for a small loop by *the area enclosed, over the radius squared*. That is the solid angle of the loop drawn on the ball.',
        ),
        formula('\\psi \\approx -\\frac{A}{a^2}', true),
        h('div', { class: 'knobs' }, shape.element, size.element, sense.element),
        h(
          'div',
          { class: 'hand' },
          h('div', { class: 'buttons' }, button('Roll it round', rollIt, 'primary', 'roll-loop')),
          pole.element,
        ),
      ),
      h(
        'div',
        { class: 'spread-stage' },
        stage.element,
        h('div', { class: 'beside' }, numbers.element, angles.element),
      ),
    ),
  )
  ask({})
  return () => undo.run()
}

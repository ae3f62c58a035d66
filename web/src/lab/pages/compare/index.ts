/** Several balls on one turntable, beside a puck on ice and the guess that most of us would make. */
import { withPlaces } from '../../../viewer/quantities'
import type { Scene } from '../../../viewer/scene'
import type { App, Page } from '../../app'
import { cleanup, fill, h } from '../../dom'
import { formula } from '../../math'
import { show as written } from '../../quantity'
import { createRunner } from '../../runner'
import { slider } from '../parts/controls'
import { finding, headingRate } from '../parts/measure'
import { createStage, playUnlessCalm } from '../parts/stage'
import { CONTESTANTS, type Contestant, fractionOf, type Table } from './bodies'

type Found = Map<string, Scene>

export const compare: Page = {
  mount(host, app) {
    const undo = cleanup()
    const stage = createStage(app, { label: 'Several balls on one turntable' })
    undo.add(() => stage.dispose())
    const on = new Set(['solid', 'hollow', 'hoop', 'puck'])
    let table: Table = { rate: 33.3, tilt: 0, push: 10 }
    let found: Found = new Map()
    let shown = table
    let framed = false

    const live = createRunner<Table, Found>({
      run: (asked, signal) => simulateAll(app, asked, signal),
      done(answer, asked) {
        stage.problem(null)
        found = answer
        shown = asked
        draw()
      },
      failed: (error) => stage.problem(error),
    })
    undo.add(() => live.stop())

    function draw(): void {
      const scenes = CONTESTANTS.filter(({ id }) => on.has(id)).map(({ id }) => found.get(id)!)
      if (scenes.length) stage.viewer.setScenes(scenes, { keepTime: framed, keepCamera: framed })
      if (!framed && scenes.length) playUnlessCalm(app, stage.viewer)
      framed ||= scenes.length > 0
      fill(
        body,
        CONTESTANTS.map((one) => row(one, found.get(one.id), shown, on, toggled)),
      )
    }

    function toggled(id: string, shown: boolean): void {
      if (shown) on.add(id)
      else if (on.size > 1) on.delete(id)
      draw()
      body.querySelector<HTMLInputElement>(`input[value="${id}"]`)?.focus()
    }

    function change(part: Partial<Table>): void {
      table = { ...table, ...part }
      live.ask(table)
    }

    const body = h('tbody')
    fill(host, layout(stage.element, controls(table, change), body))
    live.ask(table)
    return () => undo.run()
  },
}

async function simulateAll(app: App, table: Table, signal: AbortSignal): Promise<Found> {
  const options = { lane: null, signal, samples: 501, curves: false }
  const scenes = await Promise.all(CONTESTANTS.map((one) => app.api.simulate(one.scenario(table), options)))
  return new Map(
    CONTESTANTS.map(({ id, name, wrong }, i) => [id, named(scenes[i]!.scene, wrong ? 'Intuition (wrong)' : name)]),
  )
}

/** The label that the stage writes beside the body. */
function named(scene: Scene, label: string): Scene {
  return { ...scene, header: { ...scene.header, body: { ...scene.header.body, label } } }
}

function layout(stage: HTMLElement, tools: HTMLElement, body: HTMLElement): HTMLElement {
  return h(
    'div',
    { class: 'lesson spread' },
    h(
      'div',
      { class: 'spread-text' },
      h('p', { class: 'kicker' }, 'Side by side'),
      h('h1', {}, 'Same table, same start'),
      h(
        'p',
        {},
        'Put down at the same place with the same push, each ball goes round a circle of its own. Only one number of the ball counts: how its mass is spread, ',
        formula('k = I/ma^2'),
        '.',
      ),
      formula('\\kappa = \\frac{k}{1+k}\\;\\omega', true),
      tools,
    ),
    h('div', { class: 'spread-stage' }, stage),
    h(
      'div',
      {
        class: 'spread-wide table-scroll',
        tabindex: '0',
        role: 'region',
        'aria-label': 'Rates, predicted and measured',
      },
      h(
        'table',
        { class: 'rates', 'data-testid': 'rates' },
        h('caption', { class: 'sr-only' }, 'Rate of the circle as a share of the table’s rate'),
        h(
          'thead',
          {},
          h(
            'tr',
            {},
            h('th', { scope: 'col' }, 'Shown'),
            h('th', { scope: 'col' }, formula('k'), h('span', { class: 'sr-only' }, 'inertia ratio')),
            h('th', { scope: 'col' }, formula('\\kappa/\\omega'), ' predicted'),
            h('th', { scope: 'col' }, 'measured'),
            h('th', { scope: 'col' }, formula('\\kappa'), ' measured'),
          ),
        ),
        body,
      ),
    ),
  )
}

function controls(table: Table, change: (part: Partial<Table>) => void): HTMLElement {
  return h(
    'div',
    { class: 'knobs' },
    slider({
      label: 'Rate of the table',
      min: -78,
      max: 78,
      step: 0.1,
      value: table.rate,
      words: (rate) => `${withPlaces(rate, 1)} rpm`,
      change: (rate) => change({ rate }),
      testid: 'compare-rate',
    }).element,
    slider({
      label: 'Push',
      min: 0,
      max: 20,
      step: 0.5,
      value: table.push,
      words: (push) => `${push.toFixed(1)} cm/s`,
      change: (push) => change({ push }),
      testid: 'compare-push',
    }).element,
    slider({
      label: 'Tilt',
      min: 0,
      max: 0.5,
      step: 0.02,
      value: table.tilt,
      words: (tilt) => `${tilt.toFixed(2)}°`,
      change: (tilt) => change({ tilt }),
      testid: 'compare-tilt',
    }).element,
  )
}

function row(
  one: Contestant,
  scene: Scene | undefined,
  table: Table,
  on: ReadonlySet<string>,
  toggled: (id: string, shown: boolean) => void,
): HTMLElement {
  const omega = (table.rate * Math.PI) / 30
  const measured = scene ? measuredRate(one, scene, table.tilt) : null
  const shown = on.has(one.id)
  const colour = shown ? [...CONTESTANTS].filter(({ id }) => on.has(id)).findIndex(({ id }) => id === one.id) : -1
  const box = h('input', {
    type: 'checkbox',
    value: one.id,
    checked: shown,
    onchange: () => toggled(one.id, box.checked),
  })
  return h(
    'tr',
    { class: one.wrong ? 'wrong' : null, 'data-id': one.id },
    h(
      'th',
      { scope: 'row' },
      h(
        'label',
        { class: 'contestant' },
        box,
        h('span', { class: 'swatch', 'data-colour': colour }),
        h('span', {}, one.name, h('small', {}, one.wrong ? wrongNote(table) : one.note)),
      ),
    ),
    h('td', { class: 'number' }, one.ratio),
    h('td', { class: 'number' }, one.wrong ? '–' : predicted(one.share)),
    h('td', { class: 'number' }, measured === null || omega === 0 ? '–' : withPlaces(measured / omega, 4)),
    h('td', { class: 'number' }, measured === null ? '–' : [written(measured), h('span', { class: 'unit' }, ' rad/s')]),
  )
}

function wrongNote({ tilt }: Table): string {
  return tilt ? 'wrong: it slides downhill' : 'wrong: it is carried along by the table'
}

function predicted(share: string): string {
  const value = fractionOf(share)
  return share.includes('/') ? `${share} = ${value.toFixed(4)}` : share
}

/** The server's finding where it has one; else by how much the direction of motion turned, which is 0 on a straight way. */
function measuredRate(one: Contestant, scene: Scene, tilt: number): number | null {
  // Down a slope what slides flies a parabola: there is no rate to speak of.
  if (one.id === 'puck' || one.wrong) return tilt ? null : headingRate(scene)
  return finding(scene, '\\kappa')?.measured ?? null
}

/** Maps of many runs: computed live, coarse to fine; point at one, and the run of that point plays beside it. */
import { say } from '../../../viewer/elements'
import { ApiError, isAbort, type MapPart, type MapRequest, type ScenarioNumber, type Sweeps } from '../../api'
import type { App, Page } from '../../app'
import { cleanup, fill, h, uniqueId } from '../../dom'
import { createRunner } from '../../runner'
import type { Scenario } from '../../scenario'
import { encode } from '../../share'
import { button } from '../parts/controls'
import { createStage, playUnlessCalm, told } from '../parts/stage'
import { type Asked, askedBy, ofShipped, paramsOf, pointOf } from './asked'
import { createComputing, type State } from './computing'
import { createForm, firstSpans } from './form'
import { createPicture } from './picture'

const OWN = '(bench)'
const CALM = 400 // ms, after which what is pointed at is told

export const maps: Page = {
  mount(host, app) {
    const undo = cleanup()
    const leaving = new AbortController()
    undo.add(() => leaving.abort())
    fill(host, h('p', { class: 'map-waiting' }, 'Looking up the sweeps …'))
    app.api
      .sweeps({ signal: leaving.signal })
      .then((sweeps) => undo.add(show(host, app, sweeps, leaving.signal)))
      .catch((error: unknown) => {
        if (!isAbort(error)) fill(host, h('p', { role: 'alert', class: 'map-waiting' }, told(error)))
      })
    return () => undo.run()
  },
}

function show(host: HTMLElement, app: App, sweeps: Sweeps, leaving: AbortSignal): () => void {
  const undo = cleanup()
  const stage = createStage(app, { label: 'The run of the point on the map' })
  undo.add(() => stage.dispose())
  const notes = h('p', { class: 'map-notes' })
  const progress = h('p', { class: 'map-progress', 'data-testid': 'map-progress' })
  const working = button('Stop', () => (computing.state === 'computing' ? computing.stop() : computing.goOn()), 'plain')
  const bench = button('Open this run on the bench', () => void openBench(), 'plain', 'map-bench')
  bench.disabled = true
  const chooser = createChooser(sweeps, (name) => void choose(name))
  const picture = createPicture(sweeps.colours, (i, j) => pointed(i, j))
  const form = createForm(sweeps.figures, (request) => begin({ name: null, request }))
  let asked: Asked | undefined
  let run: Scenario | null = null
  let telling: ReturnType<typeof setTimeout> | undefined
  let framed = false

  const computing = createComputing(app.api, {
    drawn(part, request) {
      form.wrong(null)
      picture.draw(part, request)
      say(progress, saidOf(part))
      if (picture.at && !run) playing.ask(picture.at)
    },
    failed(error) {
      form.wrong(told(error), error instanceof ApiError ? error.key : null)
      say(progress, '')
    },
    state(state) {
      tellState(state)
    },
  })
  undo.add(() => computing.stop())

  const playing = createRunner<readonly [number, number], Scenario>({
    patience: 4000,
    run: async ([i, j], signal) => {
      if (!asked) throw new DOMException('nothing asked', 'AbortError')
      const { scenario, over } = asked.request
      const place = i * over[1].count + j
      const point = await app.api.mapPoint({ scenario, over, place }, { lane: null, signal })
      const { scene } = await app.api.simulate(point.scenario, { lane: null, signal, samples: 1500 })
      if (!signal.aborted) {
        stage.viewer.setScenes([scene], { keepCamera: framed })
        framed = true
        stage.viewer.suit()
        playUnlessCalm(app, stage.viewer)
      }
      return point.scenario
    },
    done(scenario) {
      run = scenario
      bench.disabled = false
      stage.problem(null)
    },
    failed: (error) => stage.problem(error),
    state: (busy) => stage.element.toggleAttribute('data-busy', busy),
  })
  undo.add(() => playing.stop())

  function pointed(i: number, j: number): void {
    playing.ask([i, j])
    clearTimeout(telling)
    telling = setTimeout(() => {
      app.announce(picture.said)
      void address()
    }, CALM)
  }
  undo.add(() => clearTimeout(telling))

  async function address(): Promise<void> {
    if (!asked) return
    const params = await paramsOf(asked, picture.at)
    if (app.route.page === 'maps') app.router.replace('maps', params)
  }

  function tellState(state: State): void {
    working.hidden = state === 'finished' || state === 'idle'
    say(working, state === 'computing' ? 'Stop' : 'Go on')
    host.querySelector('.maps')?.toggleAttribute('data-busy', state === 'computing')
    if (state === 'finished') app.announce('The map is finished.')
  }

  /** Show another map from its beginning. */
  function begin(next: Asked, point: [number, number] | null = null): void {
    asked = next
    playing.stop()
    run = null
    bench.disabled = true
    framed = false
    const sweep = sweeps.sweeps.find(({ name }) => name === next.name)
    say(notes, sweep?.notes ?? '')
    chooser.show(next, sweep ? Object.entries(sweep.measures) : [])
    void numbersOf(next.request)
    if (point && point[0] < next.request.over[0].count && point[1] < next.request.over[1].count) picture.point(...point)
    computing.begin(next.request)
    void address()
  }

  async function numbersOf(request: MapRequest): Promise<ScenarioNumber[]> {
    try {
      const numbers = await app.api.mapNumbers(request.scenario, { signal: leaving })
      form.show(request, numbers)
      return numbers
    } catch (error) {
      if (!isAbort(error)) form.wrong(told(error))
      return []
    }
  }

  async function choose(name: string): Promise<void> {
    const [id = '', measure] = name.split('\n')
    const sweep = sweeps.sweeps.find((one) => one.name === id)
    if (sweep) {
      begin(ofShipped(sweep, measure))
      return
    }
    const scenario = app.store.scenario
    const numbers = await numbersOf({ scenario, over: [NOTHING, NOTHING], measure: '' })
    const over = firstSpans(numbers)
    if (over) begin({ name: null, request: { scenario, over, measure: 'max hypot(vx, vy)' } })
  }

  async function openBench(): Promise<void> {
    if (run) app.navigate('bench', { s: await encode(run) })
  }

  async function read(): Promise<void> {
    try {
      begin(await askedBy(app.route.params, sweeps), pointOf(app.route.params))
    } catch (error) {
      app.toast(told(error), 'error')
      begin(await askedBy({}, sweeps))
    }
  }

  undo.add(
    app.router.subscribe((route) => {
      if (route.page === 'maps') void read()
    }),
  )
  fill(
    host,
    h(
      'div',
      { class: 'lesson maps' },
      h(
        'div',
        { class: 'maps-head' },
        h('div', {}, h('p', { class: 'kicker' }, 'Many runs at once'), h('h1', {}, 'Maps')),
        chooser.element,
      ),
      h('div', { class: 'maps-map' }, picture.element, h('div', { class: 'maps-progress' }, progress, working)),
      h('div', { class: 'maps-run' }, stage.element, h('div', { class: 'buttons' }, bench)),
      h(
        'div',
        { class: 'maps-more' },
        notes,
        h('details', { class: 'maps-change' }, h('summary', {}, 'Change this map'), form.element),
      ),
    ),
  )
  void read()
  return () => undo.run()
}

const NOTHING = { key: '', from: 0, to: 0, count: 2, scale: 'linear' } as const

/** How far a map has come. */
function saidOf(part: MapPart): string {
  const fields = part.shape[0] * part.shape[1]
  if (part.left > 0) return `${part.run} of ${fields} fields run …`
  if (part.run === fields) return `${fields} runs`
  return `${part.run} runs; the other ${fields - part.run} fields lie within one class`
}

interface Chooser {
  readonly element: HTMLElement
  show(asked: Asked, measures: [string, string][]): void
}

/** Which map: one of the shipped, or one of the scenario on the bench; and by which of its measures. */
function createChooser({ sweeps }: Sweeps, chosen: (name: string) => void): Chooser {
  const [map, measure] = [uniqueId('maps'), uniqueId('measures')]
  const select = h(
    'select',
    { id: map, 'data-testid': 'map-choice', onchange: () => chosen(select.value) },
    sweeps.map(({ name, title }) => h('option', { value: name }, title)),
    h('option', { value: OWN }, 'The scenario on the bench'),
  )
  const measures = h('select', {
    id: measure,
    'data-testid': 'map-colour',
    onchange: () => chosen(`${select.value}\n${measures.value}`),
  })
  const colour = h('div', { class: 'map-field' }, h('label', { for: measure }, 'Colour'), measures)
  return {
    element: h(
      'div',
      { class: 'maps-choice' },
      h('div', { class: 'map-field' }, h('label', { for: map }, 'Map'), select),
      colour,
    ),
    show({ name, request }, offered) {
      select.value = name ?? OWN
      colour.hidden = offered.length === 0
      fill(
        measures,
        offered.map(([word, text]) => h('option', { value: text }, word === text ? text : `${word}: ${text}`)),
      )
      measures.value = request.measure
    },
  }
}

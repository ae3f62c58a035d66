/** From a track that was measured to numbers with errors, and what they cannot tell. */
import { shownDigits, t, typedDigits } from '../../../languages/translate'
import { handOver, put, say } from '../../../viewer/elements'
import {
  ApiError,
  type ExampleTrack,
  type Fitted,
  isAbort,
  type ScenarioEntry,
  type ScenarioNumber,
  type Suggestion,
  type Track,
} from '../../api'
import type { Page } from '../../app'
import { save } from '../../bench/files'
import { cleanup, fill, h, listen, uniqueId } from '../../dom'
import { createRunner } from '../../runner'
import type { Scenario } from '../../scenario'
import { encode } from '../../share'
import { nameOf } from '../maps/axes'
import { button } from '../parts/controls'
import { createStage, playUnlessCalm, told } from '../parts/stage'
import { createFilm, isFilm } from './film'
import { createPlot } from './plot'
import { clausesSaid, createReading, type How } from './reading'
import { report } from './report'
import { createShowing } from './showing'

const BENCH = '(bench)'
const OF_EXAMPLE = '(example)'

/** How the measured axes are turned, which a picture does not show. */
const TURN: ScenarioNumber = {
  key: 'camera.rotation',
  group: 'Camera',
  label: 'Direction of its axes',
  value: 0,
  unit: 'rad',
}

/** A scenario that comes with a track. */
interface Guess extends Suggestion {
  noise: string
  called: string
}

interface Given {
  file: Blob
  name: string
  how: How
}

export const measure: Page = {
  mount(host, app) {
    const undo = cleanup()
    const leaving = new AbortController()
    undo.add(() => leaving.abort())
    const stage = createStage(app, { label: 'What was measured, on its support' })
    const plot = createPlot()
    const showing = createShowing(app.api)
    undo.add(
      () => stage.dispose(),
      () => plot.dispose(),
      () => showing.dispose(),
      app.watchSettings(() => requestAnimationFrame(() => plot.restyle())),
    )
    let given: Given | null = null
    let track: Track | null = null
    let example: Guess | null = null
    let scenario: Scenario = app.store.scenario
    let fitted: Fitted | null = null
    let numbers: readonly ScenarioNumber[] = []
    let examples: ExampleTrack[] = []

    // 1. The track
    const said = h('div', { class: 'measure-said', role: 'status', 'data-testid': 'said' })
    const wrong = h('p', { class: 'map-wrong', role: 'alert', hidden: true, 'data-testid': 'wrong' })
    const reading = createReading((how) => given && take({ ...given, how }))
    const film = createFilm({
      api: app.api,
      wrong: (error) => tell(error),
      followed(answer, file, kept) {
        took(answer)
        if (answer.suggested) {
          example = { ...answer.suggested, noise: '', called: 'The ball on the filmed table' }
          void choose(OF_EXAMPLE)
        }
        if (answer.film) showing.show({ file, film: kept, followed: answer.film, columns: answer.columns })
      },
    })
    undo.add(() => film.dispose())
    function dropped(file: File): void {
      if (isFilm(file)) {
        start(null)
        void film.take(file)
      } else take({ file, name: file.name, how: {} }, null)
    }
    const picker = createPicker(dropped)
    const offered = h('div', { class: 'buttons measure-examples', role: 'group', 'aria-label': 'Example tracks' })

    // 2. What moved
    const moved = createScenarios((name) => void choose(name))
    const free = createFree()

    // 3. The fit
    const go = button('Fit', () => fitting.ask(null), 'primary', 'fit')
    const halt = button('Stop', () => fitting.stop(), 'plain', 'fit-stop')
    let choosing: object | null = null // a scenario that is on its way
    let busy = false
    const verdict = h('div', {
      class: 'measure-verdicts',
      role: 'status',
      'aria-label': 'What was found',
      tabindex: -1,
    })
    const results = h('div', { class: 'measure-results' })
    const bench = button('Open the fitted scenario on the bench', () => void openBench(), 'plain', 'fit-bench')
    const file = button('Save fit.toml', () => fitted && save(new Blob([fitted.commented]), 'fit.toml'), 'plain')
    const after = h('div', { class: 'buttons', hidden: true }, bench, file)

    function tell(error: unknown): void {
      wrong.hidden = error === null
      say(wrong, error === null ? '' : told(error))
      free.wrong(error instanceof ApiError && error.key === 'noise')
    }

    /** What may be pressed now. */
    function ready(): void {
      say(go, busy ? 'Fitting …' : 'Fit')
      const able = !busy && track !== null && choosing === null
      if (able) go.disabled = false
      if (busy) {
        halt.hidden = false
        handOver(go, halt)
      } else handOver(halt, go)
      go.disabled = !able
      halt.hidden = !busy
    }

    ready()

    function forget(): void {
      fitting.stop()
      fitted = null
      after.hidden = true
      fill(verdict)
      fill(results)
      plot.way(null, true)
      showing.fitted(null)
    }

    /** A track is there. */
    function took(answer: Track): void {
      forget()
      track = answer
      fill(
        said,
        h('p', {}, h('strong', { translate: 'no' }, answer.title), ': ', ...clausesSaid(answer.said[0] ?? [])),
        answer.said.slice(1).map((clauses) => h('p', { class: 'map-hint' }, ...clausesSaid(clauses))),
      )
      ready()
      plot.measured(answer)
      sketch()
    }

    const reader = createRunner<Given, Awaited<ReturnType<typeof app.api.track>>>({
      run: ({ file, name, how }, signal) => app.api.track(file, name, how, { lane: null, signal }),
      done(answer, asked) {
        if (asked !== given) return
        if ('asks' in answer) {
          reading.ask(answer.asks)
          fill(said)
          return
        }
        reading.ask(null)
        took(answer)
      },
      failed: (error, { file, name }) =>
        tell(error instanceof ApiError && error.status === 413 ? tooLarge(file, name) : error),
      state: (busy) => host.firstElementChild?.toggleAttribute('data-busy', busy),
    })

    /** Read a file, or read it again in another way. */
    function take(next: Given, of: Guess | null = example): void {
      void film.take(null)
      start(next, of)
      reading.set(next.how)
      reader.ask(next)
    }

    /** Forget what was measured before: a file comes, or a film, which is none. */
    function start(next: Given | null, of: Guess | null = null): void {
      given = next
      example = of
      track = null
      tell(null)
      forget()
      ready()
      fill(said)
      showing.show(null)
      reading.ask(null)
      reading.element.hidden = next === null
      if (!of && moved.value === OF_EXAMPLE) void choose(BENCH)
    }

    function takeExample(one: ExampleTrack): void {
      take(
        { file: new Blob([one.content]), name: one.file, how: {} },
        { ...one, called: `${one.title}, as the example says` },
      )
      void choose(OF_EXAMPLE)
      app.router.replace('measure', { example: one.name })
    }

    async function choose(name: string): Promise<void> {
      const mine = {}
      choosing = mine
      tell(null)
      forget()
      ready()
      try {
        const options = { signal: leaving.signal }
        let chosen = scenario
        if (name === OF_EXAMPLE && example) chosen = example.scenario
        else if (name === BENCH) chosen = app.store.scenario
        else if (name !== OF_EXAMPLE) chosen = (await app.api.scenario(name, options)).scenario
        const known = await app.api.mapNumbers(chosen, options)
        if (choosing !== mine) return
        scenario = chosen
        numbers = [...known, TURN]
        moved.show(name, example)
        const asked = name === OF_EXAMPLE && example ? example : { free: [], noise: '' }
        free.show(
          numbers.filter(({ key }) => !key.startsWith('start.')),
          asked.free,
          asked.noise,
        )
        staging.ask(scenario)
        choosing = null
        ready()
      } catch (error) {
        if (choosing === mine && !isAbort(error)) tell(error)
      }
    }

    const staging = createRunner<Scenario, Scenario>({
      run: async (shown, signal) => {
        const { scene } = await app.api.simulate(shown, { lane: null, signal, samples: 1500 })
        if (signal.aborted) return shown
        stage.viewer.setScenes([scene])
        sketch()
        stage.viewer.suit()
        if (fitted) playUnlessCalm(app, stage.viewer)
        return shown
      },
      done: () => stage.problem(null),
      failed: (error) => stage.problem(error),
      state: (busy) => stage.element.toggleAttribute('data-busy', busy),
    })

    function sketch(): void {
      stage.viewer.setSketch(track ? placesOf(track) : null, 'measured', 'support')
    }

    const fitting = createRunner<null, Fitted>({
      patience: 20_000,
      run: (_, signal) => {
        tell(null)
        if (!track) throw new Error('There is no track yet.')
        const { keys, noise } = free.value
        return app.api.fit(
          {
            scenario,
            columns: track.columns,
            title: track.title,
            free: keys,
            noise,
            accuracy: track.accuracy,
            ...(track.film ? { view: track.film.view } : {}),
          },
          { lane: null, signal },
        )
      },
      done(answer) {
        fitted = answer
        report(verdict, results, answer, numbers)
        if (halt.matches(':focus-visible')) verdict.focus() // by keys all of the stage lies between
        after.hidden = false
        plot.way(answer.way, app.settings.reducedMotion)
        showing.fitted(answer.seen)
        staging.ask(answer.scenario)
      },
      failed: (error) => tell(error),
      state(now) {
        busy = now
        ready()
        host.firstElementChild?.toggleAttribute('data-busy', now)
      },
    })
    undo.add(
      () => reader.stop(),
      () => staging.stop(),
      () => fitting.stop(),
    )

    async function openBench(): Promise<void> {
      if (fitted) app.navigate('bench', { s: await encode(fitted.scenario) })
    }

    fill(
      host,
      h(
        'div',
        { class: 'lesson measure' },
        h(
          'div',
          { class: 'measure-text' },
          h('p', { class: 'kicker' }, 'From a film to numbers'),
          h('h1', {}, 'Measure'),
          h(
            'section',
            { 'aria-labelledby': 'measure-1' },
            h('h2', { id: 'measure-1' }, 'Your track'),
            picker.element,
            h('p', { class: 'map-hint' }, 'Or one of these, made with noise of which the truth is known:'),
            offered,
            said,
            wrong,
            film.element,
            reading.element,
          ),
          h(
            'section',
            { 'aria-labelledby': 'measure-2' },
            h('h2', { id: 'measure-2' }, 'What moved'),
            moved.element,
            free.element,
            h('div', { class: 'buttons' }, go, halt),
          ),
        ),
        h('div', { class: 'measure-seen' }, stage.element, showing.element, plot.element, verdict, results, after),
      ),
    )
    undo.add(dropping(host, dropped))

    async function begin(): Promise<void> {
      try {
        const [found, shipped] = await Promise.all([
          app.api.exampleTracks({ signal: leaving.signal }),
          app.api.scenarios({ signal: leaving.signal }),
        ])
        examples = found
        moved.offer(shipped.filter(({ motion }) => motion !== 'path'))
        fill(
          offered,
          examples.map((one) => {
            const chosen = button(one.title, () => takeExample(one), 'plain')
            put(chosen, 'title', one.about)
            return chosen
          }),
        )
        const named = examples.find(({ name }) => name === app.route.params.example)
        if (named) takeExample(named)
        else await choose(BENCH)
      } catch (error) {
        if (!isAbort(error)) tell(error)
      }
    }
    void begin()
    return () => undo.run()
  },
}

function tooLarge(file: Blob, name: string): Error {
  const size = (file.size / 2 ** 20).toFixed(0)
  const words =
    '{title} has {size} MiB, more than the lab reads. Leave out rows, or use trundle fit, which takes them all.'
  return new Error(t(words, { title: name, size }))
}

/** Where the body was seen, on the support: along x where only that was measured. */
function placesOf({ columns: { t: times = [], x, y, z } }: Track): [number, number][] | [number, number, number][] {
  if (!x && !y) return []
  const rows = times.map((_, i): (number | null)[] => [x ? x[i]! : 0, y ? y[i]! : 0, ...(z ? [z[i]!] : [])])
  return rows.filter((row) => row.every((part) => part !== null)) as [number, number][]
}

interface Picker {
  readonly element: HTMLElement
}

function createPicker(chosen: (file: File) => void): Picker {
  const input = h('input', { type: 'file', class: 'sr-only', 'data-testid': 'file' })
  input.addEventListener('change', () => {
    const file = input.files?.[0]
    input.value = ''
    if (file) chosen(file)
  })
  return {
    element: h(
      'label',
      { class: 'measure-drop' },
      input,
      h('strong', {}, 'Choose a file, or drop it here'),
      h(
        'span',
        {},
        'A film, or a track: Tracker (.trk, .trz, a copied table), Logger Pro, Capstone, Vernier, Phyphox, DeepLabCut, CSV, Excel',
      ),
    ),
  }
}

/** Files may be dropped anywhere on the page. */
function dropping(host: HTMLElement, dropped: (file: File) => void): () => void {
  const hasFiles = (event: DragEvent) => event.dataTransfer?.types.includes('Files') ?? false
  const mark = (over: boolean) => host.firstElementChild?.toggleAttribute('data-over', over)
  const undo = cleanup()
  undo.add(
    listen(window, 'dragover', (event: DragEvent) => {
      if (!hasFiles(event)) return
      event.preventDefault()
      mark(true)
    }),
    listen(window, 'dragleave', (event: DragEvent) => {
      if (event.relatedTarget === null) mark(false)
    }),
    listen(window, 'drop', (event: DragEvent) => {
      if (!hasFiles(event)) return
      event.preventDefault()
      mark(false)
      const file = event.dataTransfer?.files[0]
      if (file) dropped(file)
    }),
  )
  return () => undo.run()
}

interface Scenarios {
  readonly element: HTMLElement
  readonly value: string
  offer(shipped: readonly ScenarioEntry[]): void
  show(name: string, example: Guess | null): void
}

function createScenarios(chosen: (name: string) => void): Scenarios {
  const id = uniqueId('moved')
  const own = h('option', { value: OF_EXAMPLE, hidden: true }, 'As the example says')
  const select = h(
    'select',
    { id, 'data-testid': 'moved', onchange: () => chosen(select.value) },
    own,
    h('option', { value: BENCH }, 'The scenario on the bench'),
  )
  return {
    element: h('div', { class: 'map-field' }, h('label', { for: id }, 'A scenario that may be like it'), select),
    get value() {
      return select.value
    },
    offer(shipped) {
      select.append(...shipped.map(({ name, title }) => h('option', { value: name }, title)))
    },
    show(name, example) {
      own.hidden = example === null
      say(own, example?.called ?? '')
      select.value = name
    },
  }
}

interface Free {
  readonly element: HTMLElement
  readonly value: { keys: string[]; noise: string | null }
  show(numbers: readonly ScenarioNumber[], chosen: readonly string[], noise: string): void
  wrong(now: boolean): void
}

/** Which numbers are to be found, and how large the noise is. */
export function createFree(): Free {
  const list = h('div', { class: 'measure-free' })
  const noise = h('input', {
    type: 'text',
    placeholder: 'as the data scatter',
    autocomplete: 'off',
    'data-testid': 'noise',
  })
  let boxes: HTMLInputElement[] = []
  return {
    element: h(
      'div',
      { class: 'measure-asks' },
      h(
        'fieldset',
        {},
        h('legend', {}, 'Numbers to be found'),
        list,
        h('p', { class: 'map-hint' }, 'The start is found besides.'),
      ),
      h('label', { class: 'map-field' }, h('span', {}, 'Noise of a measured place'), noise),
    ),
    get value() {
      const keys = boxes.filter(({ checked }) => checked).map(({ value }) => value)
      return { keys, noise: typedDigits(noise.value).trim() || null }
    },
    show(numbers, chosen, given) {
      boxes = numbers.map(({ key }) => h('input', { type: 'checkbox', value: key, checked: chosen.includes(key) }))
      fill(
        list,
        boxes.map((box, i) => h('label', { class: 'toggle', title: box.value }, box, nameOf(numbers[i]!))),
      )
      noise.value = shownDigits(given)
    },
    wrong(now) {
      if (now) noise.setAttribute('aria-invalid', 'true')
      else noise.removeAttribute('aria-invalid')
    },
  }
}

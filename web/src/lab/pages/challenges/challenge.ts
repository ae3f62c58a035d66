/** One challenge: predict, do, explain; the server says whether the answer is right. */
import { typedDigits } from '../../../languages/translate'
import { say } from '../../../viewer/elements'
import type { Scene } from '../../../viewer/scene'
import type { Challenge, Judgement, Values } from '../../api'
import { isAbort } from '../../api'
import type { App } from '../../app'
import { cleanup, fill, h, uniqueId } from '../../dom'
import { type Found, note, readNotebook } from '../../notebook'
import { amount, parse, show } from '../../quantity'
import { createRunner } from '../../runner'
import type { Scenario } from '../../scenario'
import { encode } from '../../share'
import { CHALLENGE, LEVELS } from '../../texts'
import { button, choice, slider } from '../parts/controls'
import { column, vectorAt } from '../parts/measure'
import { createStage, playUnlessCalm, told } from '../parts/stage'
import { thumbnail } from './thumbnail'

export function mountChallenge(host: HTMLElement, app: App, challenge: Challenge): () => void {
  const { name, title } = challenge
  const undo = cleanup()
  const before = readNotebook().entries[name]
  const stage = createStage(app, { label: CHALLENGE.stage(title) })
  const { viewer } = stage
  const values: Values = Object.fromEntries(challenge.controls.map((one) => [one.name, one.first]))
  const keep = (part: Parameters<typeof note>[2]) => note(name, title, part)
  let scenes: Scene[] = []
  let asked = before?.hints ?? 0
  let first = true
  undo.add(() => stage.dispose())

  const live = createRunner<Values, Scene[]>({
    run: (chosen, signal) => {
      const bodies = challenge.bodies.length ? challenge.bodies : ['']
      const one = async (body: string) =>
        (await app.api.tried(name, chosen, body, { lane: null, signal, samples: 800 })).scene
      return Promise.all(bodies.map(one))
    },
    done(found) {
      stage.problem(null)
      scenes = found
      viewer.setScenes(found, { keepCamera: !first })
      if (first) viewer.suit()
      first = false
      if (!does.disabled) playUnlessCalm(app, viewer)
      read()
    },
    failed: (error) => stage.problem(error),
  })
  undo.add(() => live.stop())

  const reading = h('p', { class: 'reading number', 'data-testid': 'reading' })
  function read(): void {
    fill(reading, ...scenes.map((scene) => h('span', {}, readingOf(scene, viewer.time, challenge.bodies.length > 1))))
  }
  undo.add(viewer.on('time', read))

  // Predict
  const prediction = predicting(challenge, before?.prediction, (words) => {
    keep({ prediction: words })
    does.disabled = false
    says.hidden = true
    playUnlessCalm(app, viewer)
  })

  // Do
  const dials = challenge.controls.map((one) =>
    slider({
      label: one.label,
      min: one.least,
      max: one.most,
      step: one.step,
      value: one.first,
      words: (value) => amount(value, one.unit),
      change: (value) => {
        values[one.name] = value
        live.ask({ ...values })
      },
      testid: `control-${one.name}`,
    }),
  )
  const answering = answerOf(challenge)
  const result = h('div', { class: 'tour-remark', 'data-testid': 'result' })
  const says = h('p', { class: 'hint', hidden: before?.prediction !== undefined }, CHALLENGE.first)
  const verdict = h('p', { class: 'judgement', role: 'status', 'data-testid': 'verdict' })
  const explanation = h('p', { class: 'explanation', 'data-testid': 'explanation', hidden: true })
  const check = button(CHALLENGE.check, () => void judge(), 'primary', 'check')
  const does = h(
    'fieldset',
    { class: 'challenge-do', disabled: before?.prediction === undefined },
    h('legend', {}, part(2, CHALLENGE.do)),
    h('p', { class: 'task' }, challenge.task),
    reading,
    h(
      'div',
      { class: 'tour-controls' },
      dials.map(({ element }) => element),
      answering.element,
    ),
    h('div', { class: 'buttons' }, check, verdict),
  )

  async function judge(): Promise<void> {
    const answer = answering.value()
    if (answer === undefined) {
      say(verdict, answering.missing)
      return
    }
    if (check.ariaDisabled === 'true') return
    check.ariaDisabled = 'true' // and not disabled, which would take the focus from it
    try {
      const judged = await app.api.judged(name, values, answer)
      await judgedTo(judged, answer)
    } catch (error) {
      if (!isAbort(error)) fill(result, h('p', { class: 'alert' }, told(error)))
    }
    check.ariaDisabled = null
  }

  async function judgedTo(
    { right, found, explanation: why }: Judgement,
    answer: string | number | null,
  ): Promise<void> {
    say(verdict, right ? CHALLENGE.right : CHALLENGE.notYet)
    verdict.dataset.right = String(right)
    fill(result, found.length > 0 && findings(found))
    explanation.hidden = !right
    say(explanation, why)
    const tries = (readNotebook().entries[name]?.tries ?? 0) + 1
    const { scenario } = scenes[0]?.header ?? {}
    keep({
      tries,
      found,
      right,
      hints: asked,
      answer: answer === null ? '' : String(answer),
      chosen: challenge.controls.map(({ name: one, label, unit }) => `${label}: ${amount(values[one], unit)}`),
      link: scenario ? `#/bench?s=${await encode(scenario as unknown as Scenario)}` : '',
    })
    const picture = await thumbnail(viewer)
    if (picture) keep({ picture })
  }

  // Explain
  const id = uniqueId('explain')
  const words = h('textarea', { id, class: 'explain', rows: 4, 'aria-describedby': `${id}-hint` })
  words.value = before?.explained ?? ''
  words.addEventListener('change', () => keep({ explained: words.value }))
  const explains = h(
    'section',
    { class: 'challenge-explain' },
    h('h2', {}, part(3, CHALLENGE.explain)),
    h('label', { for: id }, challenge.explain),
    words,
    h('p', { class: 'hint', id: `${id}-hint` }, CHALLENGE.explainHint),
    explanation,
  )

  // Hints
  const hints = h('ol', { class: 'hints', 'aria-live': 'polite' })
  const more = button('', () => {
    asked += 1
    keep({ hints: asked })
    hinted()
  })
  more.dataset.testid = 'hint'
  function hinted(): void {
    asked = Math.min(asked, challenge.hints.length)
    fill(hints, ...challenge.hints.slice(0, asked).map((text) => h('li', {}, text)))
    more.hidden = asked >= challenge.hints.length
    say(more, CHALLENGE.hint(asked + 1, challenge.hints.length))
  }
  hinted()

  fill(
    host,
    h(
      'div',
      { class: 'lesson tour challenge', 'data-challenge': name },
      h(
        'article',
        { class: 'tour-step' },
        h(
          'div',
          { class: 'tour-text' },
          h('p', { class: 'kicker' }, CHALLENGE.kicker(LEVELS[challenge.level] ?? '')),
          h('h1', { class: 'tour-title', tabindex: '-1' }, title),
          h('p', {}, challenge.summary),
          prediction,
        ),
        h(
          'div',
          { class: 'tour-lab' },
          h('div', { class: 'tour-stage' }, stage.element),
          h('div', { class: 'tour-do' }, says, does, result),
        ),
        h('div', { class: 'worked' }, h('div', { class: 'buttons' }, more), hints),
        explains,
      ),
      h(
        'nav',
        { class: 'tour-nav', 'aria-label': CHALLENGE.title },
        h('a', { class: 'button', href: '#/challenges' }, CHALLENGE.all),
        h('a', { class: 'button', href: '#/report' }, CHALLENGE.report),
      ),
    ),
  )
  live.ask({ ...values })
  return () => undo.run()
}

function part(number: number, words: string): HTMLElement {
  return h('span', { class: 'part' }, h('span', { class: 'part-number' }, number), ` ${words}`)
}

/** What is expected, before anything moves. */
function predicting(challenge: Challenge, known: string | undefined, take: (words: string) => void): HTMLElement {
  const group = uniqueId('prediction')
  const { question, choices } = challenge.prediction
  return h(
    'fieldset',
    { class: 'predict', 'data-testid': 'predict' },
    h('legend', {}, part(1, CHALLENGE.predict)),
    h('p', {}, question),
    choices.map((words) =>
      h(
        'label',
        {},
        h('input', {
          type: 'radio',
          name: group,
          value: words,
          checked: words === known,
          onchange: () => take(words),
        }),
        h('span', {}, words),
      ),
    ),
  )
}

interface Answering {
  element: HTMLElement | null
  /** Null where the run is the answer; undefined while there is none. */
  value(): number | string | null | undefined
  missing: string
}

/** Where the answer is given that is not the run itself. */
export function answerOf({ answer }: Pick<Challenge, 'answer'>): Answering {
  if (answer.kind === 'run') return { element: null, value: () => null, missing: '' }
  if (answer.kind === 'choice') {
    let chosen: string | undefined
    const options = answer.choices.map((one) => [one, one] as const)
    const { element } = choice(CHALLENGE.answer, options, '' as string, (one) => {
      chosen = one
    })
    return { element, value: () => chosen, missing: CHALLENGE.choose }
  }
  const id = uniqueId('answer')
  const input = h('input', { id, class: 'answer-box number', inputmode: 'decimal', autocomplete: 'off' })
  return {
    element: h('div', { class: 'answer-row' }, h('label', { for: id }, answer.label), input),
    value() {
      const { number, unit } = parse(typedDigits(input.value))
      return number === null || unit || !Number.isFinite(number) ? undefined : number
    },
    missing: CHALLENGE.number,
  }
}

/** What was asked of the run, and what it shows. */
export function findings(found: readonly Found[]): HTMLElement {
  const head = (words: string) => h('th', { scope: 'col' }, words)
  return h(
    'div',
    { class: 'table-scroll' },
    h(
      'table',
      { class: 'versus' },
      h('caption', { class: 'sr-only' }, CHALLENGE.found),
      h('thead', {}, h('tr', {}, h('td'), head(CHALLENGE.asked), head(CHALLENGE.shown), h('td'))),
      h(
        'tbody',
        {},
        found.map((one) =>
          h(
            'tr',
            {},
            h('th', { scope: 'row' }, one.said),
            h('td', {}, bounds(one)),
            h('td', {}, amount(one.value, one.unit, 3)),
            h('td', {}, one.held ? `✓ ${CHALLENGE.held}` : `✗ ${CHALLENGE.missed}`),
          ),
        ),
      ),
    ),
  )
}

function bounds({ least, most, unit }: Found): string {
  const written = (value: number) => amount(value, unit)
  if (least !== null && most !== null) return CHALLENGE.between(show(least), written(most))
  if (least !== null) return CHALLENGE.atLeast(written(least))
  return most === 0 ? CHALLENGE.none : CHALLENGE.atMost(written(most ?? 0))
}

/** The clock, the place and the speed at this instant of the film: what one measures with. */
function readingOf(scene: Scene, time: number, named: boolean): string {
  const times = column(scene, 'time')
  let at = 0
  while (at < times.length - 1 && (times[at + 1] ?? 0) <= time) at += 1
  const place = vectorAt(column(scene, 'position'), at)
  const speed = Math.hypot(...vectorAt(column(scene, 'velocity'), at))
  const centimetres = (value: number) => (Math.round(1000 * value) / 10 + 0).toFixed(1).replace('-', '−')
  const said = CHALLENGE.reading(time.toFixed(2), centimetres(place[0]), centimetres(place[1]), centimetres(speed))
  return named ? `${scene.header.body.label}: ${said}` : said
}

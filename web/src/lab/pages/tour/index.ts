/** The tour: seven steps, in the lecture's order. #/tour/1 to #/tour/7. */
import { t } from '../../../languages/translate'
import { put } from '../../../viewer/elements'
import type { App, Page } from '../../app'
import { cleanup, fill, h, listen } from '../../dom'
import { formula } from '../../math'
import type { Scenario } from '../../scenario'
import { encode } from '../../share'
import { isTyping } from '../../shell'
import { button } from '../parts/controls'
import { createNumbers } from '../parts/numbers'
import { paragraph } from '../parts/prose'
import { mountBall } from './ball'
import { mountCylinder } from './cylinder'
import { mountFields } from './fields'
import { mountNudge } from './nudge'
import type { StepMount } from './place'
import { mountPush } from './push'
import { type StepText, TEXTS } from './texts'
import { mountTilt } from './tilt'
import { mountTurntable } from './turntable'

const MOUNTS: readonly StepMount[] = [
  mountCylinder,
  mountBall,
  mountPush,
  mountTurntable,
  mountNudge,
  mountTilt,
  mountFields,
]
const LAST = TEXTS.length

/** The step that an address names: 1 to 7; anything else is the first. */
export function stepOf(path: readonly string[]): number {
  const number = Number(path[0])
  return Number.isInteger(number) && number >= 1 && number <= LAST ? number : 1
}

export const tour: Page = {
  mount(host, app) {
    const undo = cleanup()
    let step = 0
    let takeDown: () => void = () => {}

    function show(number: number, focus: boolean): void {
      if (number === step) return
      takeDown()
      step = number
      takeDown = showStep(host, app, number)
      if (focus) {
        host.querySelector<HTMLElement>('.tour-title')?.focus({ preventScroll: true })
        window.scrollTo(0, 0)
      }
    }

    undo.add(() => takeDown())
    undo.add(
      app.router.subscribe((route) => {
        if (route.page === 'tour') show(stepOf(route.path), true)
      }),
    )
    undo.add(
      listen(document, 'keydown', (event: KeyboardEvent) => {
        if (event.defaultPrevented || isTyping(event) || event.ctrlKey || event.metaKey || event.altKey) return
        if (document.querySelector('dialog[open]')) return
        const by = wayOf(event.key, app.settings.projector)
        const to = step + by
        if (by === 0 || to < 1 || to > LAST) return
        event.preventDefault()
        app.navigate(`tour/${to}`)
      }),
    )
    show(stepOf(app.route.path), false)
    return () => undo.run()
  },
}

/** N and B; on a projector also the keys that a presenter's remote sends. Elsewhere these scroll. */
function wayOf(key: string, projector: boolean): number {
  if (key === 'n' || key === 'N' || (projector && key === 'PageDown')) return 1
  return key === 'b' || key === 'B' || (projector && key === 'PageUp') ? -1 : 0
}

function showStep(host: HTMLElement, app: App, number: number): () => void {
  const text = TEXTS[number - 1]!
  const numbers = createNumbers(`${text.title}: theory beside measurement`)
  const stage = h('div', { class: 'tour-stage' })
  const controls = h('div', { class: 'tour-controls' })
  const remark = h('div', { class: 'tour-remark', role: 'status' })
  const worked = h('div', { class: 'worked' })
  let offered: Scenario | null = null

  const yours = button(
    'Make it yours',
    () => void openBench(app, offered),
    number === LAST ? 'primary' : 'quiet',
    'make-it-yours',
  )
  put(yours, 'title', 'Open this on the bench')
  yours.hidden = true
  fill(
    host,
    h(
      'div',
      { class: 'lesson tour', 'data-step': number },
      progress(number),
      h(
        'article',
        { class: 'tour-step' },
        told(text, number),
        h(
          'div',
          { class: 'tour-lab' },
          stage,
          h('div', { class: 'tour-do' }, h('p', { class: 'task' }, text.task), controls, remark),
          numbers.element,
        ),
        worked,
        asked(text),
      ),
      h('nav', { class: 'tour-nav', 'aria-label': 'Steps' }, back(number), yours, next(number)),
    ),
  )
  document.title = t(`${text.title} · Tour · trundle lab`)
  return MOUNTS[number - 1]!({
    app,
    stage,
    controls,
    numbers,
    remark,
    worked(scene) {
      const latex = scene?.header.formula?.numbers_latex
      fill(worked, latex ? formula(latex, true) : null)
    },
    offer(scenario) {
      offered = scenario
      yours.hidden = false
    },
  })
}

async function openBench(app: App, scenario: Scenario | null): Promise<void> {
  if (scenario) app.navigate('bench', { s: await encode(scenario) })
}

function progress(number: number): HTMLElement {
  return h(
    'ol',
    { class: 'tour-progress', 'aria-label': 'Steps of the tour' },
    TEXTS.map(({ short }, i) =>
      h(
        'li',
        { class: i + 1 < number ? 'done' : null },
        h(
          'a',
          { href: `#/tour/${i + 1}`, 'aria-current': i + 1 === number ? 'step' : null },
          h('span', { class: 'tour-number' }, i + 1),
          h('span', { class: 'tour-short' }, short),
        ),
      ),
    ),
  )
}

function told({ title, text, formulas }: StepText, number: number): HTMLElement {
  return h(
    'div',
    { class: 'tour-text' },
    h('p', { class: 'kicker' }, `Step ${number} of ${LAST}`),
    h('h1', { class: 'tour-title', tabindex: '-1' }, title),
    text.map((words) => paragraph(words)),
    h(
      'div',
      { class: 'formulas' },
      formulas.map((latex) => formula(latex, true)),
    ),
  )
}

function asked({ question, answer }: StepText): HTMLElement {
  return h(
    'details',
    { class: 'question' },
    h('summary', {}, h('span', { class: 'question-kicker' }, 'Think first'), h('span', {}, question)),
    h(
      'div',
      { class: 'answer' },
      answer.map((words) => paragraph(words)),
    ),
  )
}

function back(number: number): HTMLElement {
  if (number === 1) return h('span')
  return h('a', { class: 'button', href: `#/tour/${number - 1}`, title: 'Back (B)', rel: 'prev' }, '← Back')
}

function next(number: number): HTMLElement {
  if (number === LAST) {
    return h('a', { class: 'button', href: '#/holonomy' }, 'Roll by hand →')
  }
  const { short } = TEXTS[number]!
  return h(
    'a',
    {
      class: 'primary',
      href: `#/tour/${number + 1}`,
      title: 'Next (N)',
      rel: 'next',
      'data-testid': 'next',
    },
    h('span', {}, 'Next', h('span', { class: 'tour-next' }, `: ${short}`), ' →'),
  )
}

/** The report that a pupil hands in: predictions, pictures, numbers, explanations, links. It prints well. */
import { language } from '../../../languages/translate'
import { say } from '../../../viewer/elements'
import type { App } from '../../app'
import { fill, h, uniqueId } from '../../dom'
import { type Entry, forget, type Notebook, readNotebook, writeNotebook } from '../../notebook'
import { CHALLENGE, REPORT } from '../../texts'
import { button } from '../parts/controls'
import { findings } from './challenge'

export async function drawReport(host: HTMLElement, app: App): Promise<void> {
  const notebook = readNotebook()
  const entries = Object.entries(notebook.entries)
  const print = button(REPORT.print, () => window.print(), 'primary')
  let sure = false
  const clear = button(REPORT.clear, () => {
    if (!sure) {
      sure = true
      say(clear, REPORT.sure)
      return
    }
    forget()
    void drawReport(host, app)
  })
  fill(
    host,
    h(
      'div',
      { class: 'lesson sheet' },
      h('h1', {}, REPORT.heading),
      h('p', { class: 'lead no-print' }, REPORT.lead),
      h(
        'div',
        { class: 'sheet-names' },
        named(REPORT.name, 'name', notebook),
        named(REPORT.group, 'group', notebook),
        h('p', {}, `${REPORT.date}: ${new Date().toLocaleDateString(language())}`),
      ),
      h(
        'p',
        { class: 'buttons no-print' },
        print,
        h('a', { class: 'button', href: '#/challenges' }, REPORT.toChallenges),
        entries.length > 0 && clear,
      ),
      entries.length === 0 && h('p', { class: 'empty' }, REPORT.empty),
      entries.map(([name, entry]) => section(name, entry)),
    ),
  )
}

function named(label: string, key: 'name' | 'group', notebook: Notebook): HTMLElement {
  const id = uniqueId('report')
  const input = h('input', { id, class: 'answer-box', value: notebook[key], autocomplete: 'off' })
  input.addEventListener('change', () => writeNotebook({ ...readNotebook(), [key]: input.value }))
  return h('div', { class: 'answer-row' }, h('label', { for: id }, label), input)
}

function section(name: string, entry: Entry): HTMLElement {
  const { title, prediction, chosen = [], answer, tries = 0, hints = 0, right, found = [], explained } = entry
  const result = `${right ? CHALLENGE.right : CHALLENGE.notYet} (${REPORT.tries(tries)}, ${REPORT.hints(hints)})`
  const address = entry.link ? new URL(entry.link, location.href).href : ''
  return h(
    'section',
    { class: 'sheet-part', 'data-challenge': name },
    h('h2', {}, title),
    entry.picture && h('img', { src: entry.picture, alt: REPORT.picture(title) }),
    h(
      'dl',
      {},
      ...line(REPORT.prediction, prediction ?? '–'),
      ...(tries ? line(REPORT.chosen, chosen.join('; ')) : []),
      ...(answer ? line(REPORT.answer, answer) : []),
      ...(tries ? line(REPORT.result, result) : []),
      ...line(REPORT.explanation, explained || REPORT.unexplained),
    ),
    found.length > 0 && findings(found),
    address && h('p', { class: 'sheet-link' }, h('a', { href: address }, REPORT.link)),
  )
}

function line(name: string, value: string): HTMLElement[] {
  return [h('dt', {}, name), h('dd', {}, value)]
}

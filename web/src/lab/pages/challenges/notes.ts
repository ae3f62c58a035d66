/** What a teacher wants to know of each step of the tour and each challenge, to read or to print. */
import type { Page } from '../../app'
import { fill, h } from '../../dom'
import { LEVELS, NOTES, type TeacherNote, TOUR_NOTES } from '../../texts'
import { button } from '../parts/controls'
import { told } from '../parts/stage'
import { TEXTS } from '../tour/texts'

export const notes: Page = {
  mount(host, app) {
    const challenges = h('div', {})
    fill(
      host,
      h(
        'div',
        { class: 'lesson sheet' },
        h('h1', {}, NOTES.heading),
        h('p', { class: 'lead' }, NOTES.lead),
        h(
          'p',
          { class: 'buttons no-print' },
          button(NOTES.print, () => window.print(), 'primary'),
        ),
        h('h2', {}, NOTES.tour),
        TEXTS.map(({ title }, at) => of(`${NOTES.step(at + 1)}: ${title}`, `#/tour/${at + 1}`, TOUR_NOTES[at])),
        h('h2', {}, NOTES.challenges),
        challenges,
      ),
    )
    app.api.challenges().then(
      (all) =>
        fill(
          challenges,
          ...all.map(({ name, title, level, teacher }) =>
            of(`${title} (${LEVELS[level]})`, `#/challenges/${name}`, teacher),
          ),
        ),
      (error: unknown) => fill(challenges, h('p', { class: 'alert', role: 'alert' }, told(error))),
    )
    return () => {}
  },
}

function of(title: string, address: string, note: TeacherNote | undefined): HTMLElement | null {
  if (!note) return null
  const { aim, time, wrong, apparatus } = note
  return h(
    'section',
    { class: 'sheet-part' },
    h('h3', {}, h('a', { href: address }, title)),
    h(
      'dl',
      {},
      h('dt', {}, NOTES.aim),
      h('dd', {}, aim),
      h('dt', {}, NOTES.time),
      h('dd', {}, time),
      h('dt', {}, NOTES.wrong),
      h(
        'dd',
        {},
        h(
          'ul',
          {},
          wrong.map((one) => h('li', {}, one)),
        ),
      ),
      h('dt', {}, NOTES.apparatus),
      h('dd', {}, apparatus),
    ),
  )
}

/** The front door: what this is, six pictures to begin with, and the ways on. */
import { LANGUAGES, nameOf } from '../../../languages'
import { language } from '../../../languages/translate'
import type { Page } from '../../app'
import { fill, h } from '../../dom'
import { pictureOf } from '../../pictures'
import { SIX, START } from '../../texts'

export const start: Page = {
  mount(host) {
    fill(
      host,
      h(
        'div',
        { class: 'lesson start' },
        h('header', { class: 'start-head' }, h('h1', {}, START.heading), h('p', { class: 'lead' }, START.lead)),
        h(
          'nav',
          { class: 'start-ways', 'aria-label': START.heading },
          way('tour', START.tour, START.tourSaid, true),
          way('challenges', START.challenges, START.challengesSaid),
          way('bench', START.bench, START.benchSaid),
        ),
        h('h2', { class: 'start-six' }, START.pictures),
        h('ul', { class: 'start-pictures' }, SIX.map(one)),
        h('p', {}, h('a', { href: '#/notes' }, START.teachers)),
        h('nav', { class: 'start-languages', 'aria-label': START.languages }, LANGUAGES.map(inLanguage)),
      ),
    )
    return () => {}
  },
}

function way(route: string, words: string, said: string, first = false): HTMLElement {
  return h(
    'a',
    { class: first ? 'start-way start-first' : 'start-way', href: `#/${route}` },
    h('strong', {}, words),
    h('span', {}, said),
  )
}

function inLanguage(name: string): HTMLElement {
  const here = name === language()
  return h('a', { href: `?lang=${name}`, lang: name, hreflang: name, 'aria-current': here && 'true' }, nameOf(name))
}

function one([name, caption]: (typeof SIX)[number]): HTMLElement {
  const link = h('a', { class: 'start-picture', href: `#/bench?name=${name}` }, pictureOf(name), h('span', {}, caption))
  return h('li', {}, link)
}

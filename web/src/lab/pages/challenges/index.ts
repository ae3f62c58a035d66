/** The challenges: their list, each of them, and the report on them. #/challenges, #/challenges/home-turned. */
import { t } from '../../../languages/translate'
import type { Challenge } from '../../api'
import type { App, Page } from '../../app'
import { cleanup, fill, h } from '../../dom'
import { readNotebook } from '../../notebook'
import { CHALLENGE, LEVELS } from '../../texts'
import { told } from '../parts/stage'
import { mountChallenge } from './challenge'
import { drawReport } from './report'

export const challenges: Page = {
  mount(host, app) {
    const undo = cleanup()
    let takeDown: () => void = () => {}
    let shown: string | undefined

    async function show(focus: boolean): Promise<void> {
      const name = app.route.path[0] ?? ''
      if (name === shown) return
      shown = name
      takeDown()
      takeDown = () => {}
      let all: Challenge[]
      try {
        all = await app.api.challenges()
      } catch (error) {
        fill(host, h('p', { class: 'alert', role: 'alert' }, told(error)))
        return
      }
      if (shown !== name) return
      const one = all.find((challenge) => challenge.name === name)
      if (name && !one) app.toast(CHALLENGE.unknown, 'error')
      if (one) takeDown = mountChallenge(host, app, one)
      else list(host, all)
      document.title = t(`${one?.title ?? CHALLENGE.title} · trundle lab`)
      if (!focus) return
      host.querySelector<HTMLElement>('h1')?.focus({ preventScroll: true })
      window.scrollTo(0, 0)
    }
    undo.add(
      app.router.subscribe((route) => {
        if (route.page === 'challenges') void show(true)
      }),
      () => {
        shown = undefined
        takeDown()
      },
    )
    void show(false)
    return () => undo.run()
  },
}

function list(host: HTMLElement, all: Challenge[]): void {
  const { entries } = readNotebook()
  fill(
    host,
    h(
      'div',
      { class: 'lesson challenges' },
      h('h1', { tabindex: '-1' }, CHALLENGE.heading),
      h('p', { class: 'lead' }, CHALLENGE.lead),
      h('p', {}, h('a', { class: 'button', href: '#/report' }, CHALLENGE.report)),
      h(
        'ul',
        { class: 'challenge-list' },
        all.map(({ name, title, level, summary }) => {
          const entry = entries[name]
          const state = entry?.right ? CHALLENGE.solved : entry ? CHALLENGE.tried : ''
          return h(
            'li',
            {},
            h(
              'a',
              { class: 'challenge-card', href: `#/challenges/${name}`, 'data-challenge': name },
              h('strong', {}, title),
              h('span', {}, summary),
              h(
                'span',
                { class: 'challenge-tags' },
                h('span', { class: 'level' }, LEVELS[level] ?? ''),
                state && h('span', { class: entry?.right ? 'tag-solved' : 'tag-tried' }, state),
              ),
            ),
          )
        }),
      ),
    ),
  )
}

export const report: Page = {
  mount(host, app: App) {
    void drawReport(host, app)
    return () => {}
  },
}

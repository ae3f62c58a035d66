/** The dialog to choose a scenario: the shipped ones, grouped by what they show, searched by every word. */
import { t } from '../../languages/translate'
import { say } from '../../viewer/elements'
import type { Api, ScenarioEntry } from '../api'
import { fill, h, plainly } from '../dom'
import { icon } from '../icons'
import { pictureOf } from '../pictures'
import { LEVELS } from '../texts'

/** The entries under their headings: the largest group first. */
export function grouped(entries: ScenarioEntry[]): [string, ScenarioEntry[]][] {
  const groups = new Map<string, ScenarioEntry[]>()
  for (const entry of entries) {
    const group = entry.group || 'Others'
    groups.set(group, [...(groups.get(group) ?? []), entry])
  }
  return [...groups].sort(([, some], [, others]) => others.length - some.length)
}

/** What begins with a capital is another; in the pseudo-language all of it is one. */
function firstSentence(text: string): string {
  return /^.*?[.!?](?= \p{Lu})/su.exec(text)?.[0] ?? text
}

/** Do all words of the query stand somewhere in what is said of the scenario? */
export function matches(entry: ScenarioEntry, query: string): boolean {
  const said =
    `${entry.name} ${entry.title} ${t(entry.title)} ${entry.summary} ${t(entry.summary)} ${entry.support} ${entry.body} ${entry.motion}`.toLowerCase()
  return query
    .toLowerCase()
    .split(/\s+/)
    .every((word) => said.includes(word))
}

export async function pickScenario(api: Api, choose: (name: string) => void): Promise<void> {
  const close = h('button', { class: 'icon-button', type: 'button', 'aria-label': 'Close' }, icon('close'))
  const search = h('input', {
    class: 'search',
    type: 'search',
    placeholder: 'bowl, billiard, turning …',
    'aria-label': 'Search the scenarios',
    autocomplete: 'off',
    spellcheck: 'false',
  })
  const count = h('p', { class: 'picker-count', role: 'status' }, 'Loading …')
  const list = h('div', { class: 'picker-list' })
  const dialog = h(
    'dialog',
    { class: 'dialog dialog-picker', 'aria-labelledby': 'picker-title' },
    h('header', { class: 'dialog-head' }, h('h2', { id: 'picker-title' }, 'Scenarios'), close),
    h('div', { class: 'picker-search' }, icon('search'), search, count),
    list,
  )
  close.addEventListener('click', () => dialog.close())
  dialog.addEventListener('close', () => dialog.remove())
  dialog.addEventListener('click', (event) => {
    if (event.target === dialog) dialog.close()
  })
  document.body.append(dialog)
  dialog.showModal()
  search.focus()

  let entries: ScenarioEntry[] = []
  try {
    entries = (await api.scenarios()).map((entry) => ({ ...entry, summary: plainly(entry.summary) }))
  } catch (error) {
    say(count, '')
    fill(list, h('p', { class: 'empty', role: 'alert' }, error instanceof Error ? error.message : String(error)))
    return
  }

  const groups = grouped(entries)

  function card(entry: ScenarioEntry): HTMLElement {
    const take = () => {
      dialog.close()
      choose(entry.name)
    }
    return h(
      'li',
      {},
      h(
        'button',
        { class: 'picker-card', type: 'button', onclick: take, 'data-scenario': entry.name },
        pictureOf(entry.name),
        h('strong', {}, entry.title),
        h('span', { class: 'picker-summary' }, firstSentence(t(entry.summary))),
        h(
          'span',
          { class: 'picker-tags' },
          h('span', { class: 'level' }, LEVELS[entry.level] ?? ''),
          entry.exact && h('span', { class: 'tag tag-exact' }, 'closed form'),
        ),
      ),
    )
  }

  function draw(): void {
    const query = search.value.trim()
    const shown = groups
      .map(([name, all]): [string, ScenarioEntry[]] => [name, all.filter((entry) => matches(entry, query))])
      .filter(([, members]) => members.length > 0)
    const found = shown.reduce((sum, [, members]) => sum + members.length, 0)
    say(count, `${found} of ${entries.length}`)
    fill(
      list,
      shown.map(([name, members]) =>
        h('section', { class: 'picker-group' }, h('h3', {}, name), h('ul', {}, members.map(card))),
      ),
      shown.length === 0 && h('p', { class: 'empty' }, 'No scenario has all these words. Try fewer.'),
    )
  }
  search.addEventListener('input', draw)
  search.addEventListener('keydown', (event) => {
    const first = list.querySelector<HTMLButtonElement>('.picker-card')
    if (event.key === 'Enter') first?.click()
    else if (event.key === 'ArrowDown') first?.focus()
    else return
    event.preventDefault()
  })
  list.addEventListener('keydown', (event) => {
    const way = { ArrowDown: 1, ArrowUp: -1 }[event.key]
    if (way === undefined) return
    const cards = [...list.querySelectorAll<HTMLButtonElement>('.picker-card')]
    const next = cards.indexOf(document.activeElement as HTMLButtonElement) + way
    if (next < 0) search.focus()
    else cards[next]?.focus()
    event.preventDefault()
  })
  draw()
}

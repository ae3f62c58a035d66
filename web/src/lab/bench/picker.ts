/** The dialog to choose a scenario: the shipped ones, grouped by what they show, searched by every word. */
import type { Api, ScenarioEntry } from '../api'
import { fill, h } from '../dom'
import { icon } from '../icons'

const GROUPS: [string, RegExp][] = [
  ['Turntables', /turntable|drop|off-the-rim|real-demonstration/],
  ['Rolling without forces', /^roll-(x|y|home|small|figure)/],
  ['Bowls, funnels, tubes and domes', /bowl|dish|funnel|dome|sphere-slipping|off-a-sphere|loop|golfer|trough/],
  ['Billiards, bounces and slopes', /billiard|bounc|incline|slip|force|torque|box/],
  ['Coins, hoops and discs', /coin|disc|hoop/],
  ['Tops and stones', /rattleback|tippe|routh|chaplygin/],
  ['Cylinders and rockers', /./],
]

/** Which heading a scenario stands under: by its name, the first that fits. */
export function groupOf(entry: ScenarioEntry): string {
  const name = entry.name
  if (/coin|hoop/.test(name)) return 'Coins, hoops and discs'
  if (/chaplygin/.test(name)) return 'Tops and stones'
  if (/cylinder|rocking/.test(name)) return 'Cylinders and rockers'
  return GROUPS.find(([, pattern]) => pattern.test(name))?.[0] ?? 'Others'
}

/** Do all words of the query stand somewhere in what is said of the scenario? */
export function matches(entry: ScenarioEntry, query: string): boolean {
  const said =
    `${entry.name} ${entry.title} ${entry.summary} ${entry.support} ${entry.body} ${entry.motion}`.toLowerCase()
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
    entries = await api.scenarios()
  } catch (error) {
    count.textContent = ''
    fill(list, h('p', { class: 'empty', role: 'alert' }, error instanceof Error ? error.message : String(error)))
    return
  }

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
        h('strong', {}, entry.title),
        h('span', { class: 'picker-summary' }, entry.summary.replaceAll('`', '')),
        h('span', { class: 'picker-tags' }, entry.exact ? h('span', { class: 'tag tag-exact' }, 'closed form') : null),
      ),
    )
  }

  function draw(): void {
    const found = entries.filter((entry) => matches(entry, search.value.trim()))
    count.textContent = `${found.length} of ${entries.length}`
    const names = [...new Set(['Turntables', ...GROUPS.map(([name]) => name), 'Others'])]
    const groups = names.map((name): [string, ScenarioEntry[]] => [
      name,
      found.filter((entry) => groupOf(entry) === name),
    ])
    const shown = groups.filter(([, members]) => members.length > 0)
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

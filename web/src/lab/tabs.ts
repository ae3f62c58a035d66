/** Tabs as the ARIA practices ask: arrow keys go along them, one of them is in the order of focus. */
import { say } from '../viewer/elements'
import { h, uniqueId } from './dom'

export interface Tab {
  id: string
  label: string
  panel: HTMLElement
}

export interface Tabs {
  list: HTMLElement
  panels: HTMLElement
  show(id: string): void
  readonly shown: string
  /** A small mark behind the label: "✓ 17". */
  badge(id: string, text: string, kind: string): void
  hide(id: string, hidden: boolean): void
}

export function createTabs(tabs: Tab[], label: string, changed?: (id: string) => void): Tabs {
  const word = uniqueId('tabs')
  let shown = ''
  const buttons = new Map<string, HTMLButtonElement>()
  const holders = new Map<string, HTMLElement>()
  const list = h('div', { class: 'tabs', role: 'tablist', 'aria-label': label })
  const panels = h('div', { class: 'tab-panels' })
  for (const { id, label: name, panel } of tabs) {
    const button = h(
      'button',
      {
        class: 'tab',
        type: 'button',
        role: 'tab',
        id: `${word}-${id}`,
        'aria-controls': `${word}-${id}-panel`,
        onclick: () => show(id),
      },
      name,
      h('span', { class: 'badge', hidden: true }),
    )
    const holder = h(
      'div',
      {
        class: `tab-panel tab-panel-${id}`,
        role: 'tabpanel',
        id: `${word}-${id}-panel`,
        'aria-labelledby': `${word}-${id}`,
        tabindex: '0',
        hidden: true,
      },
      panel,
    )
    buttons.set(id, button)
    holders.set(id, holder)
    list.append(button)
    panels.append(holder)
  }

  function show(id: string): void {
    if (!buttons.has(id) || id === shown) return
    shown = id
    for (const [name, button] of buttons) {
      button.setAttribute('aria-selected', String(name === id))
      button.tabIndex = name === id ? 0 : -1
      holders.get(name)!.hidden = name !== id
    }
    changed?.(id)
  }

  list.addEventListener('keydown', (event) => {
    const open = [...buttons].filter(([, button]) => !button.hidden).map(([id]) => id)
    const at = open.indexOf(shown)
    const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: open.length - 1 }[event.key]
    if (to === undefined) return
    event.preventDefault()
    event.stopPropagation()
    const id = open[(to + open.length) % open.length]
    if (id === undefined) return
    show(id)
    buttons.get(id)?.focus()
  })
  show(tabs[0]?.id ?? '')
  return {
    list,
    panels,
    show,
    get shown() {
      return shown
    },
    badge(id, text, kind) {
      const badge = buttons.get(id)?.querySelector<HTMLElement>('.badge')
      if (!badge || (badge.textContent === text && badge.dataset.kind === kind)) return
      badge.hidden = text === ''
      say(badge, text)
      badge.dataset.kind = kind
    },
    hide(id, hidden) {
      const button = buttons.get(id)
      if (!button) return
      button.hidden = hidden
      if (hidden && shown === id)
        show([...buttons.keys()].find((other) => other !== id && !buttons.get(other)!.hidden) ?? '')
    },
  }
}

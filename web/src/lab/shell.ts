/** What is round every page: header, menu, theme, projector, help, messages, and which page is shown. */
import { t } from '../languages/translate'
import { put, say } from '../viewer/elements'
import { UNREACHABLE } from './api'
import type { App, Entry } from './app'
import { fill, h, plainly } from './dom'
import { openHelp } from './help'
import { type IconName, icon, mark } from './icons'
import type { Theme } from './settings'

const THEMES: { theme: Theme; icon: IconName; label: string }[] = [
  { theme: 'system', icon: 'auto', label: 'Theme: as the system' },
  { theme: 'light', icon: 'sun', label: 'Theme: light' },
  { theme: 'dark', icon: 'moon', label: 'Theme: dark' },
]

export interface Shell {
  main: HTMLElement
  announce(text: string): void
  toast(text: string, kind?: 'info' | 'error'): void
  /** A message that stays until it is taken away. */
  hold(text: string): () => void
}

/** The frame without any page in it; `start` fills it. */
export function createShell(body: HTMLElement): Shell {
  const live = h('p', { class: 'sr-only', 'aria-live': 'polite', role: 'status' })
  const toasts = h('div', { class: 'toasts', role: 'status', 'aria-live': 'polite' })
  const main = h('main', { id: 'lab', class: 'page', tabindex: '-1' })
  const skip = h('a', { class: 'skip', href: '#lab' }, 'Skip to the page')
  skip.addEventListener('click', (event) => {
    // The hash is the route: move the focus without it.
    event.preventDefault()
    main.focus()
  })
  fill(body, skip, h('header', { class: 'head' }), main, live, toasts)
  return {
    main,
    announce(text) {
      live.textContent = t(plainly(text)) // the same once more is to be heard once more
    },
    hold(text) {
      const one = h('p', { class: 'toast working' }, text)
      toasts.append(one)
      return () => one.remove()
    },
    toast(text, kind = 'info') {
      const one = h('p', { class: `toast toast-${kind}` }, plainly(text))
      toasts.append(one)
      setTimeout(() => one.remove(), kind === 'error' ? 9000 : 3500)
    },
  }
}

export function startShell(shell: Shell, app: App, pages: Entry[]): void {
  const head = document.querySelector<HTMLElement>('.head')!
  const menued = pages.filter((page) => !page.aside)
  const links = menued.map((page) => h('a', { href: `#/${page.id}`, 'data-page': page.id }, page.title))
  const nav = h('nav', { class: 'nav', id: 'nav', 'aria-label': 'Pages' }, links)
  const menu = h('button', {
    class: 'icon-button nav-toggle',
    type: 'button',
    'aria-expanded': 'false',
    'aria-controls': 'nav',
  })
  menu.append(icon('menu'), h('span', { class: 'nav-here' }), h('span', { class: 'sr-only' }, 'Pages'))
  const unfold = (open: boolean) => {
    menu.setAttribute('aria-expanded', String(open))
    nav.toggleAttribute('data-open', open)
  }
  menu.addEventListener('click', () => unfold(menu.getAttribute('aria-expanded') !== 'true'))
  nav.addEventListener('click', () => unfold(false))
  document.addEventListener('pointerdown', (event) => {
    if (event.target instanceof Node && !head.contains(event.target)) unfold(false)
  })

  const theme = h('button', { class: 'icon-button', type: 'button', onclick: () => nextTheme(app) })
  const projector = h('button', {
    class: 'icon-button head-projector',
    type: 'button',
    'aria-label': 'Projector mode',
    title: 'Projector mode (P)',
    onclick: () => app.changeSettings({ projector: !app.settings.projector }),
  })
  projector.append(icon('projector'))
  const help = h('button', {
    class: 'icon-button',
    type: 'button',
    'aria-label': 'Help',
    title: 'Help (?)',
    onclick: openHelp,
  })
  help.append(icon('help'))
  const home = h(
    'a',
    { class: 'wordmark', href: '#/' },
    mark(),
    h('span', {}, 'trundle'),
    h('span', { class: 'wordmark-lab' }, 'lab'),
  )
  fill(head, home, menu, nav, h('div', { class: 'head-tools' }, theme, projector, help))

  const showSettings = () => {
    const now = THEMES.find((one) => one.theme === app.settings.theme) ?? THEMES[0]!
    fill(theme, icon(now.icon))
    put(theme, 'aria-label', now.label)
    put(theme, 'title', `${now.label} (Shift+T)`)
    projector.setAttribute('aria-pressed', String(app.settings.projector))
  }
  app.watchSettings(showSettings)
  showSettings()
  shortcuts(app)
  showPages(shell, app, pages, links)
}

function nextTheme(app: App): void {
  const at = THEMES.findIndex((one) => one.theme === app.settings.theme)
  const next = THEMES[(at + 1) % THEMES.length]!
  app.changeSettings({ theme: next.theme })
  app.announce(next.label)
}

/** True while keys belong to something that is typed into. */
export function isTyping(event: KeyboardEvent): boolean {
  const target = event.target as HTMLElement | null
  return !!target?.closest(
    'input:not([type=range], [type=checkbox], [type=radio]), textarea, select, [contenteditable]',
  )
}

function shortcuts(app: App): void {
  document.addEventListener('keydown', (event) => {
    if (event.defaultPrevented || isTyping(event) || event.ctrlKey || event.metaKey || event.altKey) return
    if (document.querySelector('dialog[open]')) return
    if (event.key === '?') openHelp()
    else if (event.key === 'p' || event.key === 'P') app.changeSettings({ projector: !app.settings.projector })
    else if (event.key === 'T' && event.shiftKey) nextTheme(app)
    else return
    event.preventDefault()
  })
}

function showPages(shell: Shell, app: App, pages: Entry[], links: HTMLAnchorElement[]): void {
  let shown: Entry | undefined
  let takeDown: (() => void) | undefined
  let visit = 0

  function show(first = false): void {
    const page = pages.find((one) => one.id === app.route.page) ?? pages[0]
    if (!page || page === shown) return
    takeDown?.()
    takeDown = undefined
    shown = page
    for (const link of links) {
      if (link.dataset.page === page.id) link.setAttribute('aria-current', 'page')
      else link.removeAttribute('aria-current')
    }
    say(document.querySelector('.nav-here')!, page.title)
    document.title = t(`${page.title} · trundle lab`)
    document.body.dataset.page = page.id
    shell.main.replaceChildren()
    shell.main.className = `page page-${page.id}`
    void open(page)
    if (!first) {
      shell.main.focus({ preventScroll: true })
      window.scrollTo(0, 0)
    }
  }

  async function open(entry: Entry): Promise<void> {
    const mine = ++visit
    const page = await entry.load().catch(() => undefined)
    if (mine !== visit) return // somebody has gone on, perhaps there and back
    if (page) takeDown = page.mount(shell.main, app)
    else {
      shown = undefined // to go there again is to try again
      fill(shell.main, h('p', { class: 'alert', role: 'alert' }, UNREACHABLE))
    }
  }
  app.router.subscribe(() => show())
  show(true)
}

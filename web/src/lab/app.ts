/** What every page of the lab is given, and what it must be. */
import type { Api } from './api'
import type { Parts } from './parts'
import type { Route, Router } from './router'
import type { Settings, SettingsStore } from './settings'
import type { Store } from './store'

export interface App {
  readonly api: Api
  /** What a scenario may be made of: asked once. */
  parts(): Promise<Parts>
  /** Theme, projector, reduced motion, units: as they are now. Watch `watchSettings` for changes. */
  readonly settings: Settings
  /** Light or dark, as drawn now: what a viewer or a plot should be told. */
  readonly appearance: 'light' | 'dark'
  watchSettings(listener: (settings: Settings) => void): () => void
  changeSettings: SettingsStore['change']
  readonly store: Store
  readonly router: Router
  /** Go to a page: navigate('tour/3'), navigate('bench', { s: code }). */
  navigate(route: string, params?: Record<string, string>): void
  readonly route: Route
  /** Say a result to a screen reader, politely (the page's one live region). */
  announce(text: string): void
  /** A short message that goes by itself: "Link copied". */
  toast(text: string, kind?: 'info' | 'error'): void
}

/** A page in the menu; what it is made of comes when it is opened. */
export interface Entry {
  /** Its word in the hash: "bench", "tour", "holonomy", "compare", "fields". */
  readonly id: string
  readonly title: string
  /** Not in the menu: other pages lead there. */
  readonly aside?: boolean
  load(): Promise<Page>
}

export interface Page {
  /** Build the page inside the host; returns how to take it down (dispose viewers, listeners, requests). */
  mount(host: HTMLElement, app: App): () => void
}

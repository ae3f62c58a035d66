/** The lab page: makes the app and shows the page that the address names. */
import './styles'
import { chosenLanguage, learn } from '../languages'
import { createApi } from './api'
import type { App } from './app'
import { FIRST } from './first'
import { pages } from './registry'
import { createRouter } from './router'
import { createSettings } from './settings'
import { createShell, startShell } from './shell'
import { tellWhileStarting } from './starting'
import { createStore } from './store'

await learn(chosenLanguage(location.search, navigator.languages))
const settings = createSettings()
const router = createRouter()
const shell = createShell(document.body)

/** Ask once, and again only where that failed. */
function once<T>(ask: () => Promise<T>): () => Promise<T> {
  let asked: Promise<T> | undefined
  return () => {
    asked ??= ask().catch((error: unknown) => {
      asked = undefined
      throw error
    })
    return asked
  }
}

const api = createApi()
const app: App = {
  api,
  parts: once(() => api.parts()),
  get settings() {
    return settings.value
  },
  get appearance() {
    return settings.appearance
  },
  watchSettings: (listener) => settings.subscribe(listener),
  changeSettings: (part) => settings.change(part),
  store: createStore(FIRST),
  router,
  navigate: (route, params) => router.navigate(route, params),
  get route() {
    return router.route
  },
  announce: (text) => shell.announce(text),
  toast: (text, kind) => shell.toast(text, kind),
}

startShell(shell, app, pages)
void tellWhileStarting(api, (text) => shell.hold(text))

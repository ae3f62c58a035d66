/** The module that notebooks and saved pages load: an anywidget, and what starts a saved page. */
import './fonts.css'
import type { Frame, Show, Theme, Viewer } from './contract'
import { startSavedPage } from './page'
import { type Scene, unpack } from './scene'
import { liftFonts } from './shadow'
import { createViewer } from './viewer'

export { createViewer, unpack }

/** The traits of the Python side, `trundle.views.viewer.widget.SceneWidget`. */
interface Traits {
  scenes: DataView[]
  theme: Theme
  frame: Frame
  show: Partial<Show>
  time: number
  speed: number
  loop: boolean
  playing: boolean
  projector: boolean
  height: number
}

interface Model {
  get<Name extends keyof Traits>(name: Name): Traits[Name]
  set<Name extends keyof Traits>(name: Name, value: Traits[Name]): void
  save_changes(): void
  on(event: string, listener: (message: unknown) => void): void
  off(event: string, listener: (message: unknown) => void): void
}

const TELL_EVERY = 250 // ms between two messages about the time, while it plays

function render({ model, el }: { model: Model; el: HTMLElement }): () => void {
  const host = document.createElement('div')
  host.className = 'tr-host'
  el.append(host)
  liftFonts(host)
  const place = () => {
    host.style.height = `${model.get('height')}px`
  }
  place()
  const viewer = createViewer(host, {
    theme: themeFor(model, el),
    controls: true,
    projector: model.get('projector'),
    frame: model.get('frame'),
  })
  const load = () => viewer.setScenes(scenesOf(model), { keepTime: true, keepCamera: true })
  load()
  viewer.show = model.get('show')
  viewer.seek(model.get('time'))
  const undo = [
    ...hear(model, el, viewer, { load, place }),
    ...tell(model, viewer),
    watchPage(() => {
      viewer.theme = themeFor(model, el)
    }),
  ]
  const still = matchMedia('(prefers-reduced-motion: reduce)').matches
  if (model.get('playing') && !still) viewer.play()
  return () => {
    for (const step of undo) step()
    viewer.dispose()
    host.remove()
  }
}

function scenesOf(model: Model): Scene[] {
  return model.get('scenes').map((bytes) => unpack(bytes))
}

/** Follow what Python changes. */
function hear(
  model: Model,
  el: HTMLElement,
  viewer: Viewer,
  { load, place }: { load: () => void; place: () => void },
): (() => void)[] {
  const listeners: Partial<Record<keyof Traits, () => void>> = {
    scenes: load,
    height: place,
    theme: () => {
      viewer.theme = themeFor(model, el)
    },
    projector: () => {
      viewer.projector = model.get('projector')
    },
    frame: () => {
      if (viewer.frame !== model.get('frame')) viewer.frame = model.get('frame')
    },
    show: () => {
      viewer.show = model.get('show')
    },
    speed: () => {
      viewer.speed = model.get('speed')
    },
    loop: () => {
      viewer.loop = model.get('loop')
    },
    playing: () => {
      if (model.get('playing') !== viewer.playing) model.get('playing') ? viewer.play() : viewer.pause()
    },
    time: () => {
      const apart = Math.abs(model.get('time') - viewer.time)
      // While it plays, what comes back is what another view of this model said a moment ago.
      if (apart > (viewer.playing ? (2 * TELL_EVERY * viewer.speed) / 1000 : 1e-9)) viewer.seek(model.get('time'))
    },
  }
  viewer.speed = model.get('speed')
  viewer.loop = model.get('loop')
  // A message of its own: while it plays, a trait set by Python is overtaken by what was said here a moment before.
  const asked = (message: unknown) => {
    const { seek } = message as { seek?: unknown }
    if (typeof seek === 'number') viewer.seek(seek)
  }
  const events: [string, (message: unknown) => void][] = [
    ...Object.entries(listeners).map(([name, listener]) => [`change:${name}`, listener] as [string, () => void]),
    ['msg:custom', asked],
  ]
  return events.map(([name, listener]) => {
    model.on(name, listener)
    return () => model.off(name, listener)
  })
}

/** Let Python know what is done here. */
function tell(model: Model, viewer: Viewer): (() => void)[] {
  let last = 0
  const put = <Name extends keyof Traits>(name: Name, value: Traits[Name]) => {
    if (model.get(name) === value) return
    model.set(name, value)
    model.save_changes()
  }
  const state = () => {
    put('playing', viewer.playing)
    put('time', viewer.time)
  }
  return [
    viewer.on('time', ({ time }) => {
      const now = performance.now()
      if (viewer.playing && now - last < TELL_EVERY) return
      last = now
      put('time', time)
    }),
    viewer.on('play', state),
    viewer.on('pause', state),
    viewer.on('frame', ({ frame }) => put('frame', frame)),
  ]
}

/** "auto" goes with the notebook's own theme where it says one, and else with the system's. */
function themeFor(model: Model, el: HTMLElement): Theme {
  const theme = model.get('theme')
  if (theme !== 'auto') return theme
  const body = document.body.dataset
  if (body.jpThemeLight) return body.jpThemeLight === 'true' ? 'light' : 'dark'
  if (body.vscodeThemeKind) return body.vscodeThemeKind.includes('light') ? 'light' : 'dark'
  if (document.querySelector('marimo-island, #root[data-marimo], .marimo') || el.getRootNode() instanceof ShadowRoot) {
    const dark = document.documentElement.classList.contains('dark') || document.body.classList.contains('dark')
    return dark ? 'dark' : 'light'
  }
  return 'auto'
}

/** Notebooks say their theme by attributes of the page. */
function watchPage(changed: () => void): () => void {
  const observer = new MutationObserver(changed)
  const attributeFilter = ['class', 'data-jp-theme-light', 'data-vscode-theme-kind']
  for (const element of [document.documentElement, document.body]) observer.observe(element, { attributeFilter })
  return () => observer.disconnect()
}

startSavedPage()

export default { render }

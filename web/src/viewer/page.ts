/** A saved page: its scenes lie in it, compressed, and so does this script. */
import { type Curves, createCurves } from '../curves/curves'
import { learnWithin, unzipped } from '../languages/within'
import { startLive } from '../live/page'
import type { Theme, Viewer } from './contract'
import { element, say } from './elements'
import { printed } from './printing'
import { type Scene, unpack } from './scene'
import { createViewer } from './viewer'

/** Bring a saved page to life; in any other document there is nothing to do. */
export function startSavedPage(root: Document = document): void {
  const stage = root.querySelector<HTMLElement>('[data-trundle-stage]')
  const packed = [...root.querySelectorAll<HTMLElement>('script[data-trundle-scene]')]
  if (!stage || !packed.length) return
  const note = root.querySelector<HTMLElement>('[data-trundle-note]')
  const scenes = Promise.all(packed.map(({ textContent }) => sceneOf(textContent ?? '')))
  learnWithin(root)
    .catch(() => undefined) // the page is worth more in English than not at all
    .then(() => scenes)
    .then((scenes) => {
      note?.remove()
      show(root, stage, scenes)
    })
    .catch((error: unknown) => {
      if (note) say(note, `The motion cannot be shown: ${error instanceof Error ? error.message : error}`)
      throw error
    })
}

function show(root: Document, stage: HTMLElement, scenes: Scene[]): void {
  const host = root.createElement('div')
  host.className = 'tr-host'
  stage.append(host)
  const viewer = createViewer(host, { theme: themeNow(root), controls: true })
  viewer.setScenes(scenes)
  viewer.suit()
  viewer.loop = true
  const [scene] = scenes as [Scene]
  const { live, curves } = scene.header
  const drawn = live ? startLive(root, stage, viewer, scene, live) : null
  const own = !live && scenes.length === 1 && curves?.length ? curvesOf(stage, viewer, scene) : null
  const put = offerThemes(root, (theme) => {
    viewer.theme = theme
    drawn?.restyle()
    own?.restyle()
  })
  let before = themeNow(root)
  addEventListener('beforeprint', () => {
    before = themeNow(root)
    put('light')
  })
  addEventListener('afterprint', () => put(before))
  printed(host, viewer)
  if (!matchMedia('(prefers-reduced-motion: reduce)').matches) viewer.play()
}

/** The curves of a film, beneath it. */
function curvesOf(stage: HTMLElement, viewer: Viewer, scene: Scene): Curves {
  const happens = element('p', 'page-said', { role: 'status' })
  const curves = createCurves(
    (text) => say(happens, text),
    (time) => {
      viewer.pause()
      viewer.seek(time)
    },
  )
  stage.after(element('section', 'page-curves', { 'aria-label': 'Curves' }, curves.element, happens))
  curves.update(scene)
  viewer.on('time', ({ time }) => curves.at(time))
  return curves
}

async function sceneOf(base64: string): Promise<Scene> {
  return unpack(await new Response(unzipped(base64)).arrayBuffer())
}

function themeNow(root: Document): 'light' | 'dark' {
  const chosen = root.documentElement.dataset.theme
  if (chosen === 'light' || chosen === 'dark') return chosen
  return matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light'
}

/** A switch between light and dark; until it is used, the page goes with the system. Returns what puts one on. */
function offerThemes(root: Document, changed: (theme: Theme) => void): (theme: 'light' | 'dark') => void {
  const button = root.querySelector<HTMLButtonElement>('[data-trundle-theme]')
  let chosen = false
  const put = (theme: 'light' | 'dark') => {
    root.documentElement.dataset.theme = theme
    if (button) say(button, theme === 'dark' ? 'Light' : 'Dark')
    changed(theme)
  }
  put(themeNow(root))
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', ({ matches }) => {
    if (!chosen) put(matches ? 'dark' : 'light')
  })
  if (!button) return put
  button.hidden = false
  button.addEventListener('click', () => {
    chosen = true
    put(themeNow(root) === 'dark' ? 'light' : 'dark')
  })
  return put
}

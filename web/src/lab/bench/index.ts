/** The bench: a scenario, its controls, its motion, and theory beside measurement. */
import { createCurves } from '../../curves/curves'
import { handOver, hide, say } from '../../viewer/elements'
import { shortNumber } from '../../viewer/quantities'
import { createAfterwards } from '../afterwards'
import { ApiError, isAbort } from '../api'
import type { App, Page } from '../app'
import { cleanup, fill, h, listen } from '../dom'
import { FIRST, FIRST_NAME } from '../first'
import { icon } from '../icons'
import type { Scenario } from '../scenario'
import { createTabs } from '../tabs'
import { createCard } from './card'
import { createComputing } from './computing'
import { createControls } from './controls'
import { openDerivation } from './derivation'
import { createEvents } from './events'
import { copyLink, createDownloads, createOpener } from './files'
import { createFindings, sentence } from './findings'
import { benchKeys } from './keys'
import { createLinking } from './linking'
import { pickScenario } from './picker'
import { createSheet } from './sheet'
import { createStage } from './stage'

function _mount(host: HTMLElement, app: App): () => void {
  const undo = cleanup()
  const { store, api } = app
  const stage = createStage(app)
  // First of all who hear of a change: the server computes while the controls follow.
  undo.add(store.subscribe((scenario, change) => computing.ask(scenario, change)))
  const controls = createControls(app)
  const findings = createFindings(() => void openDerivation(api, store.scenario))
  const curves = createCurves(app.toast, (time) => stage.viewer.seek(time))
  const card = createCard()
  const events = createEvents((time) => stage.viewer.seek(time))
  const linking = createLinking(app)
  const tabs = createTabs(
    [
      { id: 'controls', label: 'Controls', panel: h('div', { class: 'controls-slot' }) },
      { id: 'numbers', label: 'Numbers', panel: findings.element },
      { id: 'curves', label: 'Curves', panel: curves.element },
      { id: 'card', label: 'Card', panel: card.element },
      { id: 'events', label: 'Events', panel: events.element },
    ],
    'Results',
  )
  const afterwards = createAfterwards()
  let idle = true

  const computing = createComputing(app, {
    scene(scene, milliseconds, { fresh, restart, again }, withCurves) {
      stage.setScene(scene, { camera: !fresh, time: !fresh && !restart, rests: again })
      if (fresh) sayPace(stage.viewer.suit())
      stage.stale(null)
      controls.complain(null)
      // The path first: to lay out the numbers takes as long as to draw it.
      afterwards.run(() => {
        stage.took(milliseconds, scene)
        controls.setReach(scene.header.support.rim ?? scene.header.support.size)
        findings.update(scene)
        if (withCurves) curves.update(scene)
        events.update(scene)
        tabs.badge('events', scene.header.events.length ? String(scene.header.events.length) : '', 'count')
        stage.working(!idle)
      })
    },
    settled: (scene) => {
      app.announce(sentence(scene))
      controls.findEnds()
    },
    failed(error) {
      if (isAbort(error)) return
      const told = error instanceof ApiError ? error : new ApiError(String(error), null, 'Error', 0)
      const said = controls.complain(told)
      stage.stale(said)
      app.announce(said)
    },
    busy(is) {
      idle = !is
      if (is || !afterwards.waiting) stage.working(is)
    },
    card(state) {
      card.update(state)
      const { text, kind } = card.badge()
      tabs.badge('card', text, kind)
    },
    get curves() {
      return tabs.shown === 'curves'
    },
  })

  function sayPace(speed: number): void {
    if (speed < 1) app.toast(`In slow motion: ${shortNumber(speed)} of the true speed.`)
  }

  function opened(scenario: Scenario, source: string): void {
    stage.useTool('orbit')
    store.set(scenario, { source, opens: true })
  }

  async function take(name: string, source = 'open'): Promise<void> {
    try {
      const { scenario } = await api.scenario(name)
      linking.shipped(name, scenario)
      opened(scenario, source)
    } catch (error) {
      if (source === 'first') computing.ask(store.scenario)
      if (!isAbort(error)) app.toast(error instanceof Error ? error.message : String(error), 'error')
    }
  }

  const pick = () => void pickScenario(api, (name) => void take(name))
  const downloads = createDownloads(app, () => stage.viewer.snapshot())
  const opener = createOpener(app, (scenario) => opened(scenario, 'open'))
  const title = h('span', { class: 'bar-title' })
  const chooser = h('button', {
    class: 'bar-scenario',
    type: 'button',
    'aria-haspopup': 'dialog',
    title: 'Choose a scenario (/)',
    onclick: pick,
  })
  chooser.append(icon('search'), title)
  const back = h('button', {
    class: 'icon-button',
    type: 'button',
    'aria-label': 'Undo',
    title: 'Undo (Ctrl Z)',
    onclick: () => store.undo(),
  })
  back.append(icon('undo'))
  const again = h('button', {
    class: 'icon-button redo',
    type: 'button',
    'aria-label': 'Redo',
    title: 'Redo (Ctrl Shift Z)',
    onclick: () => store.redo(),
  })
  again.append(icon('redo'))
  const link = h('button', {
    class: 'button',
    type: 'button',
    'aria-label': 'Copy link',
    title: 'Copy a link (S)',
    onclick: () => void copyLink(app),
  })
  link.append(icon('link'), h('span', { class: 'button-word' }, 'Link'))
  const bar = h(
    'div',
    { class: 'bar' },
    chooser,
    h('div', { class: 'bar-tools' }, back, again, opener.element, link, downloads.element),
  )
  const notes = h('details', { class: 'notes' })

  const left = h('aside', { class: 'panel panel-left', 'aria-label': 'Controls' }, controls.element)
  const right = h('aside', { class: 'panel panel-right', 'aria-label': 'Results' }, tabs.list, tabs.panels)
  const grid = h('div', { class: 'bench' })
  const folds = [fold(grid, 'left', 'controls', ','), fold(grid, 'right', 'results', '.')] as const
  const sheet = createSheet(grid)
  right.prepend(sheet.handle)
  const middle = h('div', { class: 'middle' }, stage.element, folds[0], folds[1])
  fill(grid, bar, left, middle, right)
  fill(host, h('h1', { class: 'sr-only' }, 'Bench'), grid)

  let noted = ''
  function showScenario(scenario: Scenario): void {
    say(title, scenario.title ?? 'A scenario without a title')
    const text = scenario.notes?.trim() ?? ''
    hide(notes, text === '')
    if (text !== noted) {
      const paragraphs = text.split(/\n\s*\n/).map((part) => h('p', {}, part.replace(/`/g, '').replace(/\s+/g, ' ')))
      fill(notes, h('summary', {}, 'What to look for'), h('div', {}, paragraphs))
      noted = text
    }
    back.disabled &&= !store.canUndo
    again.disabled &&= !store.canRedo
    if (!store.canUndo) handOver(back, again, chooser)
    if (!store.canRedo) handOver(again, back, chooser)
    back.disabled = !store.canUndo
    again.disabled = !store.canRedo
  }

  /** On a phone, upright or on its side, and where the page is magnified, the controls are one of the tabs. */
  const narrow = matchMedia('screen and (max-width: 56rem), screen and (max-width: 76rem) and (max-height: 36rem)')
  function arrange(): void {
    const slot = tabs.panels.querySelector('.controls-slot')!
    if (narrow.matches) slot.append(notes, controls.element)
    else {
      left.append(controls.element)
      middle.prepend(notes)
    }
    tabs.hide('controls', !narrow.matches)
    if (narrow.matches) tabs.show('controls')
  }
  arrange()

  undo.add(
    listen(narrow, 'change', arrange),
    store.subscribe((scenario) => {
      showScenario(scenario)
      linking.changed(scenario)
    }),
    stage.viewer.on('time', ({ time }) => curves.at(time)),
    app.watchSettings((settings) => {
      curves.restyle()
      grid.toggleAttribute('data-left-folded', settings.projector)
      grid.toggleAttribute('data-right-folded', settings.projector)
    }),
    app.router.subscribe(() => {
      if (app.route.page === 'bench') void linking.read(take, (scenario) => opened(scenario, 'url'))
    }),
    benchKeys(app, { stage, pick, fold: (side) => folds[side === 'left' ? 0 : 1].click() }),
    () => controls.dispose(),
    () => curves.dispose(),
    () => stage.dispose(),
    () => downloads.dispose(),
    () => opener.dispose(),
    () => computing.stop(),
    () => afterwards.stop(),
    () => linking.stop(),
  )
  grid.toggleAttribute('data-left-folded', app.settings.projector)
  grid.toggleAttribute('data-right-folded', app.settings.projector)
  showScenario(store.scenario)
  const first = 'first'
  const said = linking.read(
    (name) => take(name, first),
    (scenario) => opened(scenario, first),
  )
  void said.then((found) => {
    if (found) return
    if (store.scenario === FIRST) void take(FIRST_NAME, first)
    else computing.ask(store.scenario)
  })
  return () => undo.run()
}

/** The tongue at the edge of the stage that folds a panel away. */
function fold(grid: HTMLElement, side: 'left' | 'right', what: string, key: string): HTMLButtonElement {
  const attribute = `data-${side}-folded`
  const button = h('button', {
    class: `fold fold-${side}`,
    type: 'button',
    title: `Fold the ${what} (${key})`,
    'aria-label': `Fold the ${what}`,
    'aria-expanded': 'true',
  })
  button.append(icon(side))
  button.addEventListener('click', () => grid.toggleAttribute(attribute))
  new MutationObserver(() => button.setAttribute('aria-expanded', String(!grid.hasAttribute(attribute)))).observe(
    grid,
    {
      attributeFilter: [attribute],
    },
  )
  return button
}

export const bench: Page = { mount: _mount }

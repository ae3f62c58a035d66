/** The panel of controls: built from the layout of the scenario, kept in step with the store. */
import { t } from '../../languages/translate'
import { hide, say } from '../../viewer/elements'
import { type ApiError, isAbort } from '../api'
import type { App } from '../app'
import { cleanup, fill, h, uniqueId } from '../dom'
import type { Parts } from '../parts'
import type { Json, Path, Scenario } from '../scenario'
import { valueAt, withValue } from '../scenario'
import { endsOf } from './ends'
import type { Field } from './field'
import { createField } from './field'
import { type Item, layout, type Option, rollingAgain, type Section } from './layout'

export interface Controls {
  element: HTMLElement
  /** How far the sliders of the position reach, in m: the size of the support. */
  setReach(metres: number): void
  /** Show what is wrong at the control in hand, or else at the one that is meant; returns it in the words of labels. */
  complain(error: ApiError | null): string
  /** Ask where the sliders end, with the scenario as it is. */
  findEnds(): void
  dispose(): void
}

/** Changes when other controls are needed, not when a value changes: a slider being dragged must stay. */
function shapeOf(sections: Section[]): string {
  const passing = new Set(['entry', 'fallback', 'value', 'place'])
  return JSON.stringify(sections, (key, value: unknown) => (passing.has(key) ? undefined : value))
}

export function createControls(app: App): Controls {
  const { store } = app
  const undo = cleanup()
  const alert = h('p', { class: 'alert', role: 'alert', hidden: true })
  const body = h('div', { class: 'controls-body' })
  const element = h('div', { class: 'controls' }, alert, body)
  const folded = new Map<string, boolean>()
  let fields: Field[] = []
  let places = new Map<Path, Path>()
  const selects = new Map<Path, HTMLSelectElement>()
  let shape = ''
  let reach = 0.5
  let wrong: ApiError | null = null
  let parts: Parts | undefined

  /** Its ends are asked for or known: controls that are built anew ask again. */
  let sought: Scenario | undefined
  /** The control that was changed last. */
  let hand: Path | null = null
  const changes = new Map<Path, (now: Scenario, value: Json) => Scenario>()

  const put = (next: Scenario, gesture?: string) => store.set(rollingAgain(next), { source: 'control', gesture })
  const unitKey = (path: Path) => path.replace(/\.\d+$/, '').replace(/\.\d+\./, '.')

  function makeField(item: Extract<Item, { type: 'field' }>): HTMLElement {
    const { path, entry, fallback } = item
    const changed = (now: Scenario, value: Json) => (item.set ? item.set(now, value) : withValue(now, path, value))
    const field = createField({
      path,
      entry,
      fallback,
      unit: () => {
        const unit = app.settings.units[unitKey(path)]
        return unit !== undefined && unit in entry.units ? unit : undefined
      },
      keepUnit: (unit) => {
        app.changeSettings({ units: { ...app.settings.units, [unitKey(path)]: unit } })
        update(store.scenario)
      },
      change: (value, gesture) => {
        hand = path
        put(changed(store.scenario, value), gesture)
      },
    })
    changes.set(path, changed)
    fields.push(field)
    return field.element
  }

  function makeChoice(item: Extract<Item, { type: 'choice' }>): HTMLElement {
    const id = uniqueId('choice')
    const select = h(
      'select',
      { id, onchange: () => put(item.set(store.scenario, select.value)) },
      item.options.map(option),
    )
    select.value = item.value
    selects.set(item.path, select)
    return h('div', { class: 'row', 'data-path': item.path }, h('label', { for: id }, item.label), select)
  }

  const option = ([value, label, said]: Option) => h('option', { value, title: said ?? null }, label)

  function makeSwitch(item: Extract<Item, { type: 'switch' }>): HTMLElement {
    const box = h('input', {
      type: 'checkbox',
      role: 'switch',
      checked: item.on,
      onchange: () => put(item.set(store.scenario, box.checked)),
    })
    const words = h('span', {}, item.label, item.hint && !item.on ? h('small', {}, ` ${item.hint}`) : null)
    return h('label', { class: 'switch', 'data-path': item.path }, box, words)
  }

  function makeText(item: Extract<Item, { type: 'text' }>): HTMLElement {
    const id = uniqueId('text')
    const input = h('input', {
      id,
      type: 'text',
      class: 'formula',
      spellcheck: 'false',
      autocomplete: 'off',
      value: String(valueAt(store.scenario, item.path) ?? ''),
      onchange: () => put(withValue(store.scenario, item.path, input.value)),
    })
    return h('div', { class: 'row row-text', 'data-path': item.path }, h('label', { for: id }, item.label), input)
  }

  function makeAdd(item: Extract<Item, { type: 'add' }>): HTMLElement {
    const select = h(
      'select',
      { 'aria-label': item.label, onchange: () => put(item.set(store.scenario, select.value)) },
      h('option', { value: '', selected: true }, `${item.label} …`),
      item.options.map(option),
    )
    return h('div', { class: 'row adding' }, select)
  }

  function make(item: Item): HTMLElement {
    switch (item.type) {
      case 'field':
        return makeField(item)
      case 'choice':
        return makeChoice(item)
      case 'switch':
        return makeSwitch(item)
      case 'text':
        return makeText(item)
      case 'add':
        return makeAdd(item)
      case 'remove':
        return h(
          'button',
          { class: 'quiet small', type: 'button', onclick: () => put(item.set(store.scenario)) },
          item.label,
        )
    }
  }

  function makeSection(section: Section): HTMLElement {
    const open = !(folded.get(section.id) ?? section.folded ?? false)
    const details = h(
      'details',
      {
        class: 'section',
        open,
        'data-section': section.id,
        ontoggle: () => void folded.set(section.id, !details.open),
      },
      h('summary', {}, h('h2', {}, section.title)),
      h('div', { class: 'section-body' }, section.items.map(make)),
    )
    return details
  }

  /** Where the keyboard was, so that new controls do not lose it. */
  function focusedPath(): string | undefined {
    const at = document.activeElement
    if (!at || !body.contains(at)) return undefined
    return at.closest<HTMLElement>('[data-path]')?.dataset.path
  }

  function build(sections: Section[]): void {
    const path = focusedPath()
    fields = []
    selects.clear()
    fill(body, sections.map(makeSection))
    if (path) body.querySelector<HTMLElement>(`[data-path="${CSS.escape(path)}"] :is(input, select)`)?.focus()
  }

  function update(scenario: Scenario): void {
    if (!parts) return
    const sections = layout(scenario, reach, parts)
    const now = shapeOf(sections)
    const anew = now !== shape
    if (anew) {
      shape = now
      build(sections)
    }
    const items = sections.flatMap((section) => section.items)
    places = new Map()
    for (const item of items) {
      if (item.type === 'choice') selects.get(item.path)!.value = item.value
      if (item.type !== 'field') continue
      const at = item.place ?? item.path
      places.set(item.path, at)
      const field = fields.find((one) => one.path === item.path)
      field?.update(valueAt(scenario, at) ?? (item.fallback as Json | undefined))
    }
    place()
    if (anew && sought === scenario) findEnds()
  }

  /** The error at the control of its key, or of the nearest one; above all where none fits. */
  function place(): void {
    const key = wrong?.key?.replace(/\[(\d+)\]/g, '.$1') ?? null
    const hit = fields.find((field) => field.path === hand) ?? (key === null ? undefined : nearest(key))
    const said = wrong ? inWords(wrong.message) : null
    for (const field of fields) field.complain(field === hit ? said : null)
    hide(alert, said === null || hit !== undefined)
    say(alert, said && !hit ? said : '')
    hit?.element.closest('details')?.setAttribute('open', '')
  }

  /** A message of the package with labels for its keys. */
  function inWords(message: string): string {
    return message.replace(/`([^`]*)`/g, (_, key: string) => {
      const place = key.replace(/\[(\d+)\]/g, '.$1')
      const at = ({ path }: Field) => places.get(path) ?? path
      const field = fields.find((one) => at(one) === place) ?? fields.find((one) => at(one).split('.').at(-1) === place)
      if (field) return t('“{label}”', { label: t(field.label) })
      const word = /^[a-z_.\d]+$/.test(place)
        ? (place
            .split('.')
            .filter((part) => /\D/.test(part))
            .at(-1) ?? '')
        : key
      return t('“{label}”', { label: t(word.replaceAll('_', ' ')) })
    })
  }

  function nearest(key: string): Field | undefined {
    const at = (field: Field) => places.get(field.path) ?? field.path
    return (
      fields.find((field) => at(field) === key) ??
      fields.find((field) => at(field).startsWith(`${key}.`)) ??
      fields.find((field) => key.startsWith(`${at(field)}.`))
    )
  }

  function findEnds(): void {
    sought = store.scenario
    endsFound(sought, fields).catch((error: unknown) => {
      if (!isAbort(error)) app.toast(error instanceof Error ? error.message : String(error), 'error')
    })
  }

  async function endsFound(scenario: Scenario, asked: Field[]): Promise<void> {
    element.removeAttribute('data-ends')
    const sliding = asked.map((field) => ({
      now: field.now,
      at: field.at,
      share: field.share,
      with: (value: Json) => rollingAgain(changes.get(field.path)!(scenario, value)),
    }))
    const ends = await endsOf(sliding, (scenarios) => app.api.possible(scenarios), inWords)
    if (store.scenario !== scenario || fields !== asked) return
    for (const [i, field] of asked.entries()) field.limit(ends[i]!)
    element.dataset.ends = scenario.title ?? '' // for tests: known of this scenario
  }

  undo.add(
    store.subscribe((_, { source }) => {
      if (source !== 'control') {
        hand = null
        for (const field of fields) field.limit({ low: null, high: null })
      }
      queueMicrotask(() => update(store.scenario)) // by then it is on its way to be computed
    }),
  )
  app.parts().then(
    (found) => {
      parts = found
      update(store.scenario)
    },
    (error: Error) => {
      hide(alert, false)
      say(alert, error.message)
    },
  )
  return {
    element,
    setReach(metres) {
      const next = Math.max(0.05, metres)
      if (Math.abs(next - reach) < 0.2 * reach) return
      reach = next
      shape = ''
      if (!body.contains(document.activeElement)) update(store.scenario)
    },
    complain(error) {
      wrong = error
      place()
      if (error === null) for (const field of fields) field.accept()
      return error ? inWords(error.message) : ''
    },
    findEnds,
    dispose: () => undo.run(),
  }
}

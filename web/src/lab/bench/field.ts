/** One number of the scenario: typed with its unit, dragged by a slider, stepped by the arrow keys. */
import { shownDigits, typedDigits } from '../../languages/translate'
import { hide, put, say } from '../../viewer/elements'
import { h, uniqueId } from '../dom'
import { brief, parse, rounded, siUnit, stepped, suited, toSI, type Units, write } from '../quantity'
import type { Json, Path } from '../scenario'

/** What a control shows of a number. */
export interface Entry {
  label: string
  units: Units
  /** To begin with. */
  unit: string
  /** Range of the slider, SI. It widens where the value lies outside. */
  min: number
  max: number
  /** The slider goes by decades. */
  decades: boolean
  hint?: string
}

export interface FieldOptions {
  path: Path
  entry: Entry
  /** What holds while the scenario does not say. */
  fallback?: Json | undefined
  /** The unit that the visitor chose for this place before. */
  unit(): string | undefined
  keepUnit(unit: string): void
  /** A new value; those of one gesture share a word. */
  change(value: Json, gesture?: string): void
}

/** The last value of a slider that can be computed, and why there is no more. */
export interface Limit {
  value: Json
  why: string
}

export interface Field {
  element: HTMLElement
  path: Path
  label: string
  update(value: Json | undefined): void
  /** Show the package's message at the control, or take it away. */
  complain(message: string | null): void
  /** What it holds now. */
  now(): Json
  /** What the slider would say at a share of its length; null where it says nothing. */
  at(share: number): Json | null
  /** Where the slider stands, as a share of its length. */
  share(): number
  /** Where it ends before its own end: the last value that can start, and why no more; null: nowhere. */
  limit(ends: Record<'low' | 'high', Limit | null>): void
  /** What the control holds could be computed: the value to go back to from one that is refused. */
  accept(): void
  focus(): void
}

const NOTCHES = 1000

export function createField(options: FieldOptions): Field {
  const { entry, path } = options
  const id = uniqueId('field')
  const units = [entry.unit, ...Object.keys(entry.units).filter((unit) => unit !== entry.unit)]
  let value: Json | undefined = options.fallback
  let range = { min: entry.min, max: entry.max }
  let typing = false
  let gesture = 0
  /** What Escape goes back to: while something is typed, what held before; after a refusal, the last good value. */
  let before: Json | undefined
  /** The last value that was accepted, and the one before it, since an answer may be that of an older value. */
  let good: { now: Json | undefined; earlier: Json | undefined } | undefined
  let refused = false
  let limits: Record<'low' | 'high', Limit | null> = { low: null, high: null }

  const input = h('input', {
    id,
    class: 'field-number',
    type: 'text',
    inputmode: 'text',
    autocomplete: 'off',
    spellcheck: 'false',
    'aria-describedby': `${id}-message`,
  })
  const unit = h('select', { class: 'field-unit', 'aria-label': `Unit of ${entry.label}` })
  const slider = h('input', {
    class: 'slider',
    type: 'range',
    min: 0,
    max: NOTCHES,
    step: 1,
    'aria-label': `${entry.label}, slider`,
  })
  const message = h('p', { class: 'field-message', id: `${id}-message`, hidden: true })
  const end = h('p', { class: 'field-end', hidden: true, 'aria-live': 'polite' })
  const hasUnits = units.length > 1 || units[0] !== ''
  const element = h(
    'div',
    { class: 'field', 'data-path': path },
    h('label', { class: 'field-label', for: id, title: entry.hint ?? null }, entry.label),
    h('div', { class: 'field-value' }, input, hasUnits && unit),
    slider,
    end,
    message,
  )

  /** Was the value refused, in a unit that is none for this place, without one, or as no number at all? */
  function misfit(): boolean {
    return refused && toSI(value, entry.units) === null
  }

  /** The unit shown: the visitor's choice, else the one written, else SI; never that of a value that was refused. */
  function shownUnit(): string {
    const written = parse(misfit() ? good?.now : value).unit
    if (written && !units.includes(written)) return written
    const usual = written || (units[0] ?? '')
    const { number } = parse(value)
    return options.unit() ?? (number === null || !hasUnits ? usual : suited(number, usual, entry.units))
  }

  function fillUnits(): void {
    const now = shownUnit()
    const all = units.includes(now) ? units : [...units, now]
    if (unit.options.length !== all.length || [...unit.options].some((o, i) => o.value !== all[i]))
      unit.replaceChildren(
        ...all.map((name) =>
          h('option', { value: name }, name.replaceAll('*', '·').replace('^2', '²').replace('^3', '³')),
        ),
      )
    unit.value = now
  }

  /** What the text box shows: the digits as written where they can stay, a conversion where the unit differs. */
  function digits(): string {
    const found = parse(value)
    if (misfit()) return typeof value === 'string' ? value : found.digits
    if (found.number === null || typeof value === 'object') return found.digits
    if (typeof value === 'number' && !hasUnits) return String(rounded(value, 6))
    if (typeof value === 'string' && hasUnits && !found.unit) return found.digits // which the package refuses
    const shown = shownUnit()
    const written = found.unit || siUnit(entry.units)
    if (shown === written) return found.digits
    const from = entry.units[written]
    const to = entry.units[shown]
    return from === undefined || to === undefined ? found.digits : String(rounded((found.number * from) / to, 6))
  }

  function place(si: number, { min, max } = range): number {
    if (entry.decades) return Math.log(Math.max(si, min) / min) / Math.log(max / min)
    return (si - min) / (max - min)
  }

  function amountAt(place: number, { min, max } = range): number {
    return entry.decades ? min * (max / min) ** place : min + (max - min) * place
  }

  /** All that the slider is to go through, as far as nobody has found that it ends before. */
  function whole(si: number): { min: number; max: number } {
    return {
      min: si < entry.min ? (entry.decades ? Math.max(si / 2, 1e-12) : si * 1.5) : entry.min,
      max: si > entry.max ? si * 1.5 : entry.max,
    }
  }

  function widen(si: number): void {
    range = whole(si)
    const [low, high] = [limitOf('low'), limitOf('high')]
    if (low !== null) range.min = Math.min(low, si)
    if (high !== null) range.max = Math.max(high, si)
  }

  const limitOf = (end: 'low' | 'high') => {
    const limit = limits[end]
    return limit && toSI(limit.value, entry.units)
  }

  /** At an end beyond which there is no motion it says why. */
  function drawEnd(si: number): void {
    const [low, high] = [limitOf('low'), limitOf('high')]
    const stuck = low !== null && high !== null && !(high - low > 1e-9 * Math.max(Math.abs(low), Math.abs(high)))
    const near = (end: number | null) => end !== null && Math.abs(si - end) <= 1e-9 * Math.abs(end)
    const at = near(high) ? limits.high : near(low) ? limits.low : null
    slider.disabled = stuck
    put(slider, 'title', (stuck ? (limits.high ?? limits.low) : at)?.why ?? '')
    hide(end, refused || (at === null && !stuck))
    say(end, stuck ? `Nothing else goes. ${limits.high!.why}` : at ? `It ends here. ${at.why}` : '')
  }

  function draw(): void {
    if (hasUnits) fillUnits()
    if (!typing) input.value = shownDigits(document.activeElement === input ? digits() : brief(digits()))
    const si = toSI(value, entry.units)
    const formula = si === null && typeof value === 'string'
    element.toggleAttribute('data-formula', formula)
    put(input, 'title', formula ? String(value) : '')
    slider.disabled = si === null
    if (si === null) return
    if (!slider.matches(':active')) widen(si)
    drawEnd(si)
    const at = range.max > range.min ? Math.min(1, Math.max(0, place(si))) : 0.5
    slider.value = String(Math.round(at * NOTCHES))
    const zero = entry.decades ? 0 : Math.min(1, Math.max(0, place(0)))
    slider.style.setProperty('--from', `${Math.min(zero, at) * 100}%`)
    slider.style.setProperty('--to', `${Math.max(zero, at) * 100}%`)
    put(slider, 'aria-valuetext', `${brief(digits())} ${hasUnits ? shownUnit() : ''}`.trim())
  }

  function commit(next: Json, word?: string): void {
    value = next
    options.change(next, word ? `${path}#${word}` : undefined)
    draw()
  }

  /** What was typed, with the unit shown where none was. */
  function typed(): { value: Json; known: boolean } {
    const found = parse(typedDigits(input.value))
    if (found.number === null) return { value: input.value.trim(), known: false }
    const written = found.unit || (hasUnits ? shownUnit() : '')
    const known = written === '' || written in entry.units
    return { value: written === '' ? found.number : `${found.digits} ${written}`, known }
  }

  input.addEventListener('input', () => {
    if (!typing) before = refused ? good?.now : value
    typing = true
    const { value: next, known } = typed()
    if (known) commit(next, `typing${gesture}`)
  })
  input.addEventListener('change', () => {
    typing = false
    gesture += 1
    const found = parse(typedDigits(input.value))
    if (found.unit && found.unit in entry.units) options.keepUnit(found.unit)
    const { value: next } = typed()
    if (next !== value) commit(next)
    else draw()
  })
  input.addEventListener('focus', () => {
    const all = shownDigits(digits())
    if (typing || input.value === all) return
    input.value = all
    input.select() // as a box is that one comes to by the keyboard: other text takes its place
  })
  input.addEventListener('blur', () => {
    typing = false
    draw()
  })
  input.addEventListener('keydown', (event) => {
    if (event.key === 'Escape' && (typing || refused)) {
      const back = typing ? before : good?.now
      typing = false
      if (back !== undefined && back !== value) commit(back, `typing${gesture}`)
      else draw()
      event.stopPropagation()
      return
    }
    step(event)
  })

  /** Up and down step by a digit; with Shift ten times as much, with Alt a tenth. */
  function step(event: KeyboardEvent): void {
    const direction = { ArrowUp: 1, ArrowDown: -1, PageUp: 1, PageDown: -1 }[event.key]
    const sideways = event.target === slider ? { ArrowRight: 1, ArrowLeft: -1 }[event.key] : undefined
    const way = direction ?? sideways
    if (way === undefined || event.ctrlKey || event.metaKey) return
    const si = toSI(value, entry.units)
    if (si === null) return
    event.preventDefault()
    const scale = event.shiftKey || event.key.startsWith('Page') ? 10 : event.altKey ? 0.1 : 1
    const factor = entry.units[shownUnit()] ?? 1
    const next = stepped(si / factor, way, scale)
    typing = false
    commit(write(next * factor, entry.units, hasUnits ? shownUnit() : '', 12), 'step')
    input.value = shownDigits(digits())
  }

  slider.addEventListener('keydown', step)
  slider.addEventListener('pointerdown', () => {
    gesture += 1
  })
  slider.addEventListener('input', () => {
    const next = amountSaid(Number(slider.value) / NOTCHES, range)
    const si = toSI(next, entry.units) ?? 0
    const [low, high] = [limitOf('low'), limitOf('high')]
    const kept = high !== null && si >= high ? limits.high : low !== null && si <= low ? limits.low : null
    commit(kept?.value ?? next, `slide${gesture}`)
  })

  /** The round number that a place of the slider stands for. */
  function amountSaid(share: number, within: typeof range): Json {
    const shown = hasUnits ? shownUnit() : ''
    const factor = entry.units[shown] ?? 1
    const raw = amountAt(share, within) / factor
    const fine = grid(factor, within)
    const next = entry.decades ? rounded(raw, 3) : rounded(Math.round(raw / fine) * fine, 9)
    return write(next * factor, entry.units, shown, 9)
  }

  /** Round numbers for the slider: 1, 2 or 5 in some decade, two hundred or more of them over its range. */
  function grid(factor: number, { min, max }: typeof range): number {
    const fine = (max - min) / Math.abs(factor) / 200
    const decade = 10 ** Math.floor(Math.log10(fine))
    return decade * ([5, 2].find((part) => part * decade <= fine) ?? 1)
  }

  unit.addEventListener('change', () => {
    const si = toSI(value, entry.units)
    options.keepUnit(unit.value)
    if (si !== null) commit(write(si, entry.units, unit.value, 9))
    else draw()
  })

  draw()
  return {
    element,
    path,
    label: entry.label,
    update(next) {
      const said = next ?? options.fallback
      if (said !== value) typing = false
      value = said
      good ??= { now: said, earlier: said }
      draw()
    },
    now: () => value ?? null,
    at(share) {
      const si = toSI(value, entry.units)
      return si === null ? null : amountSaid(share, whole(si))
    },
    share() {
      const si = toSI(value, entry.units) ?? 0
      return place(si, whole(si))
    },
    limit(ends) {
      limits = ends
      if (!typing) draw()
    },
    accept() {
      if (!typing && good?.now !== value) good = { now: value, earlier: good?.now }
    },
    complain(text) {
      const was = misfit()
      refused = text !== null
      if (refused && good?.now === value) good = { now: good?.earlier, earlier: good?.earlier }
      if (misfit() !== was) draw()
      hide(message, text === null)
      say(message, text ?? '')
      element.toggleAttribute('data-wrong', text !== null)
      if (text === null) input.removeAttribute('aria-invalid')
      else input.setAttribute('aria-invalid', 'true')
    },
    focus: () => input.focus(),
  }
}

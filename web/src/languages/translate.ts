/**
 * What the page says, in the language of its reader.
 *
 * English stands where it is said; a catalogue has the other language, by the English text: `{name}` in both stands for
 * what varies. A text that is put together here or comes from the server is known again by what does not vary, if its
 * values can be said as well: numbers, which get the decimal sign of the language, and what the catalogue has. Only
 * `{title}` (and `{title2}`) may be anything: it was written by somebody. What cannot be said so stays English as a whole.
 */

/** English texts, and what they are in another language. */
export type Catalogue = Readonly<Record<string, string>>

type Values = Readonly<Record<string, string>>

interface Template {
  fixed: string
  pattern: RegExp
  names: string[]
  said: string
}

const SLOT = /\{(\w+)\}/g
const TITLE = /^title\d?$/
const MOST = 4000 // texts that are remembered
const LONG = 1000 // letters, more than which no text has that is put together: what is longer was written by somebody
const VALUE = 200 // letters, more than which no value has

let entries = new Map<string, string>()
let templates: Template[] = []
let known = new Map<string, string>()
let recognitions = new Map<string, string | undefined>()
let mark = '.'
let speaking = 'en'

/** From now on say everything in this language. */
export function speak(language: string, catalogue: Catalogue): void {
  speaking = language
  mark = new Intl.NumberFormat(language).format(0.5).includes(',') ? ',' : '.'
  entries = new Map(Object.entries(catalogue))
  known = new Map()
  recognitions = new Map()
  const varying = [...entries].filter(([key]) => key.search(SLOT) >= 0)
  const fixed = (key: string) => key.replace(SLOT, '').length
  // What is most particular is tried first.
  templates = varying.sort(([one], [other]) => fixed(other) - fixed(one)).map(([key, said]) => template(key, said))
}

/** The language of the page, for dates and for the document. */
export function language(): string {
  return speaking
}

function template(key: string, said: string): Template {
  const parts = key.split(SLOT) // fixed, name, fixed, name, ..., fixed
  const pattern = parts.map((part, i) => (i % 2 ? '(.+?)' : part.replace(/[.*+?^${}()|[\]\\]/g, '\\$&'))).join('')
  const either = pattern.replace(/^\p{L}/u, (first) => `[${first.toLowerCase()}${first.toUpperCase()}]`) // a line or not
  // The longest of what does not vary, but for the first letter: most texts are told apart by it.
  const fixed = parts
    .map((part, i) => (i % 2 ? '' : i === 0 ? part.slice(1) : part))
    .reduce((one, other) => (other.length > one.length ? other : one))
  return { fixed, pattern: new RegExp(`^${either}$`, 's'), names: parts.filter((_, i) => i % 2), said }
}

/** Say an English text in the language of the page; with values, what stands for its `{names}`. */
export function t(text: string, values: Values = {}): string {
  if (entries.size === 0) return filled(text, values)
  const found = known.get(text) ?? remembered(text)
  return filled(found, values)
}

function remembered(text: string): string {
  const [, before = '', core = '', after = ''] = /^(\s*)(.*?)(\s*)$/s.exec(text) ?? []
  const found = core === '' ? text : before + translated(core) + after
  if (known.size >= MOST) known.clear()
  known.set(text, found)
  return found
}

/** Where a text may be taken apart, the larger parts first. */
const BREAKS = [/(?<=[^\d\s][.!?…]) (?=\S)|\n/, /(?<=;) (?=\S)/, /(?<=[^\d\s]:) (?=\S)/]

function translated(text: string): string {
  if (!/\p{L}{2}/u.test(text)) return entries.get(text) ?? withMarks(text)
  const said = entry(text) ?? recognized(text) ?? aroundQuoted(text) ?? beforeItsStop(text)
  if (said !== undefined) return said
  const at = BREAKS.find((one) => one.test(text))
  if (!at) return withMarks(text)
  const between = text.match(new RegExp(at, 'g')) ?? []
  return text
    .split(at)
    .map((one, i) => t(one) + (between[i] ?? ''))
    .join('')
}

/**
 * A text whose catalogue has `$1$`, `$2$` for its formulas, and numbers between backticks for what stands in a file:
 * the words are the same, whatever these are.
 */
function aroundQuoted(text: string): string | undefined {
  const quoted: string[] = []
  const key = text.replace(/([$`])[^$`]+\1/g, (one, mark: string) => `${mark}${quoted.push(one)}${mark}`)
  const said = quoted.length > 0 && key !== text ? (entry(key) ?? recognized(key)) : undefined
  return said?.replace(/([$`])(\d+)\1/g, (_, __, number) => quoted[number - 1] ?? '')
}

/** A part of a text, which ends as the whole would not. */
function beforeItsStop(text: string): string | undefined {
  const bare = text.slice(0, -1)
  const said = /[;:.]$/.test(text) ? (entry(bare) ?? recognized(bare)) : undefined
  return said === undefined ? undefined : said + text.slice(-1)
}

/** The entry of a text, however its first letter is written: a label may stand within a sentence. */
function entry(text: string): string | undefined {
  const first = text.charAt(0)
  const other = first === first.toUpperCase() ? first.toLowerCase() : first.toUpperCase()
  return entries.get(text) ?? entries.get(other + text.slice(1))
}

/** What a template makes of a text; found once, since the parts of a text recur in each other. */
function recognized(text: string): string | undefined {
  if (text.length > LONG) return undefined
  if (recognitions.has(text)) return recognitions.get(text)
  const found = takenApart(text)
  if (recognitions.size >= MOST) recognitions.clear()
  recognitions.set(text, found)
  return found
}

function takenApart(text: string): string | undefined {
  for (const { fixed, pattern, names, said } of templates) {
    const match = text.includes(fixed) ? pattern.exec(text) : null
    if (!match) continue
    const values = names.map((name, i) => [name, TITLE.test(name) ? t(match[i + 1]!) : sayable(match[i + 1]!)] as const)
    if (values.some(([, value]) => value === undefined)) continue
    const whole = filled(said, Object.fromEntries(values) as Values)
    return /^\p{Lu}/u.test(text) ? whole.charAt(0).toUpperCase() + whole.slice(1) : whole
  }
  return undefined
}

/** A value as it is said: a number with its unit, or what the catalogue has; undefined of any other words. */
function sayable(value: string): string | undefined {
  if (value.length > VALUE) return entry(value)
  return entry(value) ?? recognized(value) ?? (/\p{L}{4}|\p{L}{2,}\s+\p{L}{2}/u.test(value) ? undefined : t(value))
}

function filled(text: string, values: Values): string {
  return text.replace(SLOT, (slot, name: string) => values[name] ?? slot)
}

/** Numbers with the decimal sign of the language; in a list, what separates them is another. */
function withMarks(text: string): string {
  if (mark === '.') return text
  return text.replace(/(\d)\.(?=\d)/g, `$1${mark}`).replace(/(\d,\d+[^,;]*), (?=[-−]?\d)/g, '$1; ')
}

/** Digits as they stand in a box: with the decimal sign of the language. */
export function shownDigits(digits: string): string {
  return mark === '.' ? digits : digits.replace(/^(\s*[-−+]?\d*)\.(?=\d)/, `$1${mark}`)
}

/** What was typed, with a point where the language has another sign, or where the reader has. */
export function typedDigits(text: string): string {
  return text.replace(/^(\s*[-−+]?\d*),(?=\d)/, '$1.')
}

/** The attributes that are read or heard. */
export const WORDED: ReadonlySet<string> = new Set([
  'aria-label',
  'aria-roledescription',
  'aria-valuetext',
  'alt',
  'label',
  'placeholder',
  'title',
])

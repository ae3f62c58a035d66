/** What a file does not say of itself: asked when it has to be known, and to be changed at any time. */
import { shownDigits, t, typedDigits } from '../../../languages/translate'
import { handOver } from '../../../viewer/elements'
import type { Question } from '../../api'
import { fill, h, uniqueId } from '../../dom'
import { button } from '../parts/controls'
import { marked } from './report'

export type How = Record<string, string>

export interface Reading {
  readonly element: HTMLElement
  /** Ask; null takes the question away. */
  ask(question: Question | null): void
  /** What is said so far; an empty object says nothing. */
  set(how: How): void
}

interface Asked {
  key: string
  label: string
  question: string
  choices?: readonly string[]
  hint?: string
  /** Digits, which have the decimal sign of the reader. */
  digits?: boolean
}

/** Each with what it is, in words, and answers to choose from where there are few. */
const FIELDS: readonly Asked[] = [
  { key: 'track', label: 'Track', question: 'The file holds several tracks. Which one?' },
  { key: 'units', label: 'Unit of places', question: 'In which unit are the places?', hint: 'cm, mm, px' },
  { key: 'time', label: 'Unit of time', question: 'What is time counted in?', hint: 's, ms, frame' },
  { key: 'rate', label: 'Frames a second', question: 'How many frames were taken a second?', hint: '60', digits: true },
  { key: 'pixel', label: 'Size of a pixel', question: 'How large is a pixel?', hint: '0.8 mm', digits: true },
  {
    key: 'y',
    label: 'y grows',
    question: 'Does y grow upwards, as in graphs, or downwards, as in pictures?',
    choices: ['', 'up', 'down'],
  },
  { key: 'angles', label: 'Unit of angles', question: 'In which unit are the angles?', hint: 'deg, rad' },
  {
    key: 'sense',
    label: 'Angles grow',
    question: 'Seen from above, does the angle grow clockwise?',
    choices: ['', 'clockwise', 'anticlockwise'],
  },
  {
    key: 'decimal',
    label: 'Decimal sign',
    question: 'Is "1,234" a little more than one, or a thousand?',
    choices: ['', 'point', 'comma'],
  },
  {
    key: 'columns',
    label: 'Columns',
    question: 'Which column is which?',
    hint: 't=frame_time, x=u, y=v',
  },
]

const digitsOf = (key: string) => FIELDS.some((one) => one.key === key && one.digits)

/** What the package says of a file, with the names of this page for its options: “Unit of angles” for --angles. */
function byLabels(sentence: string): string {
  return sentence.replace(/--([a-z]+)/g, (option, name: string) => {
    const field = FIELDS.find(({ key }) => key === (name === 'unit' ? 'units' : name))
    return field ? `“${t(field.label)}”` : option
  })
}

/** A sentence about a track, whose clauses are said one by one: which of them there are differs from file to file. */
export function clausesSaid(clauses: readonly string[]): Node[] {
  const said = clauses.map((clause) => byLabels(t(clause))).join(', ')
  return marked(said && `${said}.`).map((part) => (typeof part === 'string' ? new Text(part) : part))
}

export function createReading(changed: (how: How) => void): Reading {
  let how: How = {}
  const inputs = new Map<string, HTMLInputElement | HTMLSelectElement>()
  const asked = h('div', { class: 'measure-question', role: 'group', hidden: true, 'data-testid': 'question' })
  const rows = FIELDS.map(({ key, label, choices, hint }) => {
    const id = uniqueId('how')
    const input = choices
      ? h(
          'select',
          { id },
          choices.map((choice) => h('option', { value: choice }, choice || 'as the file says')),
        )
      : h('input', { id, type: 'text', placeholder: hint, autocomplete: 'off', spellcheck: 'false' })
    input.addEventListener('change', () => say(key, input.value))
    inputs.set(key, input)
    return h('div', { class: 'map-field' }, h('label', { for: id }, label), input)
  })

  function say(key: string, value: string): void {
    const { [key]: _, ...others } = how
    const said = (digitsOf(key) ? typedDigits(value) : value).trim()
    how = said ? { ...others, [key]: said } : others
    changed(how)
  }

  const about = h('summary', {}, 'How the file is read')

  function ask(question: Question | null): void {
    if (!question) handOver(asked, about)
    asked.hidden = question === null
    if (!question) return
    const { key, rule, received, choices } = question
    const field = FIELDS.find((one) => one.key === key)
    const id = uniqueId('question')
    const answers = choices.map((choice) => button(choice, () => say(key, choice), 'plain'))
    const other = h('input', { type: 'text', 'aria-labelledby': id, placeholder: field?.hint, autocomplete: 'off' })
    const form = h(
      'form',
      { class: 'measure-other', novalidate: true },
      other,
      button('Take it', () => form.requestSubmit()),
    )
    form.addEventListener('submit', (event) => {
      event.preventDefault()
      if (other.value.trim()) say(key, other.value)
    })
    asked.setAttribute('aria-labelledby', id)
    const closed = key === 'track' || field?.choices !== undefined
    fill(
      asked,
      h('p', { class: 'measure-asked', id }, field?.question ?? `\`${key}\` ${rule}.`),
      h('p', { class: 'map-hint' }, `${received}`),
      h('div', { class: 'buttons' }, answers),
      closed ? null : form,
    )
    ;(answers[0] ?? other).focus({ preventScroll: true })
  }

  return {
    element: h(
      'div',
      { class: 'measure-reading' },
      asked,
      h('details', {}, about, h('div', { class: 'measure-fields' }, rows)),
    ),
    ask,
    set(next) {
      how = next
      for (const [key, input] of inputs) input.value = digitsOf(key) ? shownDigits(next[key] ?? '') : (next[key] ?? '')
    },
  }
}

/** Formulas by KaTeX, built as nodes: its styles go through the CSSOM, which a strict style policy allows. */
import katex from 'katex'
import 'katex/dist/katex.min.css'
import { shownDigits, t } from '../languages/translate'
import { put } from '../viewer/elements'
import { h } from './dom'
import { SYMBOLS } from './texts'

/** What is no symbol: words, units, unit vectors, and what stands below the line. */
const NONE = /\\(?:text|mathrm|operatorname|hat)\s*(?:\{[^}]*\}|\\?[A-Za-z]+)|_(?:\{[^}]*\}|\\?[A-Za-z]+)/g

/** What the symbols of a formula mean: "κ: angular rate of the ball’s circle". */
export function meanings(latex: string): string {
  const found = new Set(latex.replace(NONE, '').match(/\\[A-Za-z]+|[A-Za-z]/g))
  const known = Object.entries(SYMBOLS).filter(([command]) => found.has(command))
  return known.map(([, [sign, meaning]]) => `${sign}: ${t(meaning)}`).join('; ')
}

/** Put a formula into an element: drawn for the eye, as MathML for the ear, and at the pointer what its symbols mean. */
function math(host: HTMLElement, latex: string, display = false): void {
  host.replaceChildren()
  const meant = meanings(latex)
  put(host, 'title', meant)
  put(host, 'aria-description', meant)
  try {
    katex.render(withMarks(latex), host, {
      displayMode: display,
      output: 'htmlAndMathml',
      fleqn: true,
      strict: false,
      trust: false,
      // An arrow over a letter needs an inline style, which the policy forbids; bold says vector as well.
      macros: { '\\vec': '\\boldsymbol{#1}' },
    })
  } catch {
    // What KaTeX cannot set is shown as it is written: its own way of saying so needs inline styles.
    host.replaceChildren(h('code', {}, latex))
  }
}

/** Numbers with the decimal sign of the page; in braces, or a comma would be followed by a space. */
function withMarks(latex: string): string {
  return latex.replace(/\d+\.\d+/g, (number) => shownDigits(number).replace(',', '{,}'))
}

/** A new element with the formula in it. */
export function formula(latex: string, display = false): HTMLElement {
  const { element, set } = changing(display)
  set(latex)
  return element
}

export interface Changing {
  element: HTMLElement
  set(latex: string): void
}

/** A place for formulas, one after another: the same one is not set and laid out again. */
export function changing(display = false): Changing {
  const element = h(display ? 'div' : 'span', { class: display ? 'math-block' : 'math' })
  let shown: string | undefined
  return {
    element,
    set(latex) {
      if (latex === shown) return
      shown = latex
      math(element, latex, display)
      if (display) watch(element)
    },
  }
}

// Tells of a first size too, once the page has been laid out: to ask sooner would lay it out once more.
const sizes =
  typeof ResizeObserver === 'function'
    ? new ResizeObserver((entries) => {
        for (const { target } of entries) reachable(target as HTMLElement)
      })
    : undefined

/** A formula wider than its place can be scrolled, so it must be reached by keyboard. */
function watch(element: HTMLElement): void {
  sizes?.unobserve(element) // or what is new inside, in the same place, would not be told of
  sizes?.observe(element)
}

function reachable(element: HTMLElement): void {
  if (element.scrollWidth > element.clientWidth) element.tabIndex = 0
  else element.removeAttribute('tabindex')
}

// A font that comes late widens what is inside, and not the box that is watched.
document.fonts?.addEventListener('loadingdone', () => {
  for (const element of document.querySelectorAll<HTMLElement>('.math-block')) reachable(element)
})

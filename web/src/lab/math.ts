/** Formulas by KaTeX, built as nodes: its styles go through the CSSOM, which a strict style policy allows. */
import katex from 'katex'
import 'katex/dist/katex.min.css'
import { h } from './dom'

/** Put a formula into an element, with its source as the name a screen reader says. */
export function math(host: HTMLElement, latex: string, display = false): void {
  host.replaceChildren()
  katex.render(latex, host, { displayMode: display, output: 'html', throwOnError: false, strict: false, trust: false })
  host.setAttribute('role', 'math')
  host.setAttribute('aria-label', spoken(latex))
}

/** A new element with the formula in it. */
export function formula(latex: string, display = false): HTMLElement {
  const element = h(display ? 'div' : 'span', { class: display ? 'math-block' : 'math' })
  math(element, latex, display)
  return element
}

/** LaTeX without its markup: good enough to be heard. */
function spoken(latex: string): string {
  return latex
    .replace(/\\(?:d|t)?frac\s*\{([^{}]*)\}\s*\{([^{}]*)\}/g, '($1) over ($2)')
    .replace(/\\(?:mathrm|mathbf|text|operatorname|boldsymbol|hat|vec|bar)\s*\{([^{}]*)\}/g, '$1')
    .replace(/\\dot\s*\{?(\w+)\}?/g, '$1 dot')
    .replace(/\\ddot\s*\{?(\w+)\}?/g, '$1 double dot')
    .replace(/\\times/g, ' times ')
    .replace(/\\cdot/g, ' times ')
    .replace(/\\([A-Za-z]+)/g, '$1 ')
    .replace(/[{}\\,;!]/g, ' ')
    .replace(/\s+/g, ' ')
    .trim()
}

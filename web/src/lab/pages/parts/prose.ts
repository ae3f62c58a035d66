/** Text with a little markup: $formula$, *emphasis*. */
import { t } from '../../../languages/translate'
import { h } from '../../dom'
import { formula } from '../../math'

export type Fragment = { kind: 'text' | 'emphasis' | 'math'; text: string }

/** Split a text at its $...$ and *...*. A star inside a formula is the formula's. */
export function fragments(text: string): Fragment[] {
  const found: Fragment[] = []
  for (const [whole, math, emphasis] of text.matchAll(/\$([^$]+)\$|\*([^*$]+)\*|[^$*]+|[$*]/g)) {
    if (math !== undefined) found.push({ kind: 'math', text: math })
    else if (emphasis !== undefined) found.push({ kind: 'emphasis', text: emphasis })
    else found.push({ kind: 'text', text: whole })
  }
  return found
}

export function prose(text: string): Node[] {
  return fragments(t(text)).map(({ kind, text: words }) => {
    if (kind === 'math') return formula(words)
    return kind === 'emphasis' ? h('em', {}, words) : document.createTextNode(words)
  })
}

export function paragraph(text: string, kind?: string): HTMLParagraphElement {
  return h('p', kind ? { class: kind } : {}, ...prose(text))
}

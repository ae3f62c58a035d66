/** A language that nobody speaks: what stays plain on the page is in no catalogue, and every word is long. */
import type { Catalogue } from './translate'

const VOWELS: Readonly<Record<string, string>> = { a: 'á', e: 'é', i: 'í', o: 'ó', u: 'ú', y: 'ý' }

/** Formulas and what varies stay: the rest gets its vowels marked and doubled. */
function disguised(text: string): string {
  const parts = text.split(/(\{\w+\}|\$[^$]+\$)/)
  const strange = (letter: string) => {
    const low = VOWELS[letter.toLowerCase()] ?? letter
    return letter === letter.toLowerCase() ? low + low : low.toUpperCase() + low
  }
  return `⟦${parts.map((part, i) => (i % 2 ? part : part.replace(/[aeiouy]/gi, strange))).join('')}⟧`
}

export function pseudo(catalogue: Catalogue): Catalogue {
  return Object.fromEntries(Object.keys(catalogue).map((key) => [key, disguised(key)]))
}

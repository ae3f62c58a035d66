// Which of the texts on the standard input, a list, no catalogue has: those that stay plain in the pseudo-language.
import { readFileSync } from 'node:fs'

const here = new URL('../../web/src/languages/', import.meta.url)
const { speak, t } = await import(new URL('translate.ts', here))
const { pseudo } = await import(new URL('pseudo.ts', here))
speak('en', pseudo(JSON.parse(readFileSync(new URL('de.json', here), 'utf8'))))
const unmarked = (word) => /^[A-Z]?[a-z]{2,}$/.test(word) && word.length > 2 && /[aeiou]/i.test(word)
const plain = (text) => (text.replace(/\$[^$]*\$|`[^`]*`|(?<=\d |[ií]n )(rad|deg|min)\b/g, '').match(/\p{L}+/gu) ?? []).some(unmarked)
const texts = JSON.parse(readFileSync(0, 'utf8'))
console.log(JSON.stringify(texts.filter((text) => plain(t(text)))))

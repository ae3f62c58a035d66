/** The languages of a page that is one file: its catalogues lie in it, and it is written in English. */
import { chosenAmong, nameOf, PSEUDO } from './chosen'
import { pseudo } from './pseudo'
import { type Catalogue, speak, t, WORDED } from './translate'

const NO_WORDS = 'script, style, pre, code, textarea, kbd, mtext, [translate=no], [lang]:not(html)'

/** Say the page in the language that its link asks for, or the browser; tell where the others are. */
export async function learnWithin(root: Document = document): Promise<void> {
  const packed = [...root.querySelectorAll<HTMLElement>('script[data-trundle-language]')]
  const languages = ['en', ...packed.map(({ dataset }) => dataset.trundleLanguage ?? '')]
  const language = chosenAmong(languages, location.search, navigator.languages)
  offer(root, languages, language)
  const catalogue = language === PSEUDO ? packed[0] : packed.find(({ dataset }) => dataset.trundleLanguage === language)
  if (!catalogue) return
  const entries = JSON.parse(await unzippedText(catalogue.textContent ?? '')) as Catalogue
  if (language === PSEUDO) speak('en', pseudo(entries))
  else speak(language, entries)
  root.documentElement.lang = language === PSEUDO ? 'en' : language
  root.title = t(root.title)
  sayAll(root.body)
}

function sayAll(body: HTMLElement): void {
  const walk = document.createTreeWalker(body, NodeFilter.SHOW_TEXT)
  for (let node = walk.nextNode() as Text | null; node; node = walk.nextNode() as Text | null)
    if (!node.parentElement?.closest(NO_WORDS) && node.data.trim()) node.data = t(node.data)
  for (const name of WORDED)
    for (const element of body.querySelectorAll(`[${name}]`))
      element.setAttribute(name, t(element.getAttribute(name) ?? ''))
}

function offer(root: Document, languages: readonly string[], spoken: string): void {
  const place = root.querySelector('[data-trundle-languages]')
  for (const language of languages) {
    if (!place || language === spoken) continue
    const link = root.createElement('a')
    link.href = `?lang=${language}`
    link.lang = link.hreflang = language
    link.textContent = nameOf(language)
    place.append(link)
  }
}

async function unzippedText(base64: string): Promise<string> {
  return new Response(unzipped(base64)).text()
}

/** What lies in a page in base64, compressed. */
export function unzipped(base64: string): ReadableStream {
  const bytes = Uint8Array.from(atob(base64.trim()), (letter) => letter.charCodeAt(0))
  return new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'))
}

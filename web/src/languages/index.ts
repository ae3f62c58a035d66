/** Which languages there are: English, and one for each catalogue beside this file. */
import { chosenAmong, PSEUDO } from './chosen'
import { pseudo } from './pseudo'
import { type Catalogue, speak } from './translate'

export { nameOf } from './chosen'

const FILES = import.meta.glob<Catalogue>('./*.json', { import: 'default' })
const of = (path: string) => path.replace(/^\.\/|\.json$/g, '')

/** "en", "de": what a reader may choose. */
export const LANGUAGES: readonly string[] = ['en', ...Object.keys(FILES).map(of)]

/** What the link says (`?lang=de`), else the first of the browser's languages that there is. */
export function chosenLanguage(search: string, preferred: readonly string[]): string {
  return chosenAmong(LANGUAGES, search, preferred)
}

/** Fetch a language's catalogue and speak it; English where it does not come. */
export async function learn(language: string): Promise<void> {
  const [first] = Object.keys(FILES)
  const path = language === PSEUDO ? first : `./${language}.json`
  const fetched = path && FILES[path]
  if (!fetched) return
  try {
    const catalogue = await fetched()
    if (language === PSEUDO) speak('en', pseudo(catalogue))
    else speak(language, catalogue)
    document.documentElement.lang = language === PSEUDO ? 'en' : language
  } catch {
    // The page is worth more in English than not at all.
  }
}

/** Which of the languages that there are is spoken. */

/** Each text of the first catalogue in letters that show what is in none. */
export const PSEUDO = 'pseudo'

/** What the link says (`?lang=de`), else the first of the browser's languages that there is. */
export function chosenAmong(languages: readonly string[], search: string, preferred: readonly string[]): string {
  const asked = new URLSearchParams(search).get('lang')
  const wanted = asked ? [asked, ...preferred] : preferred
  const offered = asked === PSEUDO ? [...languages, PSEUDO] : languages
  const base = (tag: string) => tag.toLowerCase().split('-')[0] ?? ''
  return wanted.map(base).find((one) => offered.includes(one)) ?? 'en'
}

/** What a language calls itself. */
export function nameOf(language: string): string {
  return new Intl.DisplayNames([language], { type: 'language' }).of(language) ?? language
}

/** What the pages of a static site do that hold no motion themselves. */
import { learnWithin } from '../languages/within'

// What is to be pasted into other pages needs the whole address, which only the page knows.
for (const code of document.querySelectorAll<HTMLTextAreaElement>('textarea[data-page]')) {
  const page = code.dataset.page ?? ''
  code.value = code.value.replace(`"${page}"`, `"${new URL(page, location.href).href}"`)
  code.addEventListener('focus', () => code.select())
}

// A language that was asked for goes along.
const asked = new URLSearchParams(location.search).get('lang')
if (asked)
  for (const [selector, name] of [
    ['a[href$=".html"]', 'href'],
    ['iframe[src$=".html"]', 'src'],
  ] as const)
    for (const element of document.querySelectorAll(selector))
      element.setAttribute(name, `${element.getAttribute(name)}?lang=${encodeURIComponent(asked)}`)

void learnWithin()

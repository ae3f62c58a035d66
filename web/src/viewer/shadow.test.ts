// @vitest-environment happy-dom
import { expect, test } from 'vitest'
import { liftFonts } from './shadow'

const FACE = '@font-face { font-family: "Inter Variable"; src: url("data:font/woff2;base64,AA==") }'
const lifted = () => [...document.head.querySelectorAll('style')].map(({ textContent }) => textContent)

test('a widget in a shadow root declares its own fonts in the page, once, and nobody else’s', () => {
  const page = document.createElement('div')
  document.body.append(page)
  const root = page.attachShadow({ mode: 'open' })
  root.innerHTML = `<style>${FACE} @font-face { font-family: Lora; src: url("lora.woff2") } p { margin: 0 }</style><p></p>`
  // happy-dom lists no sheets of a shadow root.
  Object.defineProperty(root, 'styleSheets', { value: [root.querySelector('style')!.sheet] })
  liftFonts(root.querySelector('p')!)
  liftFonts(root.querySelector('p')!)
  expect(lifted()).toEqual([expect.stringContaining('Inter Variable')])
  expect(lifted()[0]).not.toMatch(/Lora|margin/)
})

test('a widget in the page itself has them there already', () => {
  document.head.replaceChildren()
  document.body.innerHTML = `<style>${FACE}</style><p></p>`
  liftFonts(document.querySelector('p')!)
  expect(lifted()).toEqual([])
})

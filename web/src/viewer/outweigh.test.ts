// @vitest-environment happy-dom
import { readFileSync } from 'node:fs'
import { expect, test } from 'vitest'

test('a notebook’s own rules for buttons do not reach those of the viewer', () => {
  const own = document.createElement('style')
  own.textContent = readFileSync('src/viewer/viewer.css', 'utf8')
  const theirs = document.createElement('style')
  theirs.textContent = '.its-page button { border-radius: 0; padding: 9px }'
  document.head.append(own, theirs)
  document.body.innerHTML =
    '<div class="its-page"><div class="tr-viewer"><button class="tr-button tr-play"></button><button class="tr-switch"></button></div></div>'
  const [play, arrow] = [...document.querySelectorAll('button')].map((button) => getComputedStyle(button))
  expect(play!.borderRadius).toBe('50%')
  expect(arrow!.borderRadius).toMatch(/rem|px/)
  expect(arrow!.padding).not.toBe('9px')
})

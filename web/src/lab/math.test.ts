import { afterEach, expect, it, vi } from 'vitest'
import german from '../languages/de.json'
import { speak } from '../languages/translate'
import { formula, meanings } from './math'

vi.hoisted(() => Object.defineProperty(document, 'compatMode', { value: 'CSS1Compat' })) // KaTeX asks for it
afterEach(() => speak('en', {}))

it('says at the pointer and to the ear what the symbols of a formula mean', () => {
  speak('de', german)
  const { title, attributes } = formula('R_x')
  expect(title).toBe('R: Kontaktkraft der Unterlage auf den Körper')
  expect(attributes.getNamedItem('aria-description')?.value).toBe(title)
})

it('has the decimal sign of the language in its numbers', () => {
  const written = () => formula('v_d = 0.03681\\,\\mathrm{m/s} + f(1, 2.50)').querySelector('.katex-html')?.textContent
  expect(written()).toContain('0.03681')
  speak('de', german)
  expect(written()).toContain('0,03681')
  expect(written()).toContain('(1,2,50)')
})

it('knows each symbol in any dress, and takes no unit, index or unit vector for one', () => {
  const signs = (latex: string) =>
    meanings(latex)
      .split('; ')
      .map((one) => one.charAt(0))
      .join('')
  expect(signs('\\kappa = \\frac{k}{1+k}\\;\\omega')).toBe('κωk')
  expect(signs('\\mathbf{V} - a\\,\\mathbf{\\Omega}\\times\\hat n = 0')).toBe('Ω')
  expect(signs('|f| / N')).toBe('Nf')
  expect(signs('\\mu_k\\,g\\,\\hat k = 3\\,\\mathrm{N} \\text{ where } x')).toBe('')
})

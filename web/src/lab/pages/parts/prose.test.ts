import { describe, expect, it } from 'vitest'

// KaTeX looks at this once, when it is loaded; the test's document has no doctype.
Object.defineProperty(document, 'compatMode', { value: 'CSS1Compat' })
const { fragments, paragraph } = await import('./prose')

describe('text with formulas', () => {
  it('is split at formulas and emphasis', () => {
    expect(fragments('It is $x = a\\phi$, *always*.')).toEqual([
      { kind: 'text', text: 'It is ' },
      { kind: 'math', text: 'x = a\\phi' },
      { kind: 'text', text: ', ' },
      { kind: 'emphasis', text: 'always' },
      { kind: 'text', text: '.' },
    ])
  })

  it('leaves a lone sign alone, and a star in a formula', () => {
    expect(fragments('5 * 3')).toEqual([
      { kind: 'text', text: '5 ' },
      { kind: 'text', text: '*' },
      { kind: 'text', text: ' 3' },
    ])
    expect(fragments('$a * b * c$')).toEqual([{ kind: 'math', text: 'a * b * c' }])
  })

  it('becomes elements', () => {
    const made = paragraph('So $v = \\omega r$ and *nothing* else.')
    expect(made.querySelector('.math .katex')).not.toBeNull()
    expect(made.querySelector('em')?.textContent).toBe('nothing')
  })
})

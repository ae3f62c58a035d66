import { afterEach, describe, expect, it } from 'vitest'
import { saidOf } from '../lab/api'
import { chosenLanguage } from '.'
import german from './de.json'
import { pseudo } from './pseudo'
import { type Catalogue, shownDigits, speak, t, typedDigits } from './translate'

afterEach(() => speak('en', {}))

describe('saying a text', () => {
  it('leaves English as it is', () => {
    expect(t('Rolls at 3.5 m/s')).toBe('Rolls at 3.5 m/s')
    expect(t('Rolls at {speed}', { speed: '3.5 m/s' })).toBe('Rolls at 3.5 m/s')
  })

  it('takes the entry, also within a sentence and between spaces', () => {
    speak('de', { Rim: 'Rand', 'Has a {part}': 'Mit {part}' })
    expect(t('Rim')).toBe('Rand')
    expect(t(' rim ')).toBe(' Rand ')
    expect(t('Has a rim')).toBe('Mit Rand')
  })

  it('knows a template again, and gives its numbers the decimal sign', () => {
    speak('de', { 'reverses its spin after {time}': 'kehrt nach {time} um' })
    expect(t('reverses its spin after 2.85 s')).toBe('kehrt nach 2,85 s um')
    expect(t('Reverses its spin after 2.85 s')).toBe('Kehrt nach 2,85 s um')
    expect(t('(1.5, -0.25, 3)')).toBe('(1,5; -0,25; 3)')
  })

  it('mixes no languages: with a value that it cannot say, the whole stays', () => {
    speak('de', { '{found} of {all}': '{found} von {all}', '{title} · lab': '{title} · Labor' })
    expect(t('3 of 7')).toBe('3 von 7')
    expect(t('Rate of the circle')).toBe('Rate of the circle')
    expect(t('Rate of the circle · lab')).toBe('Rate of the circle · Labor')
  })

  it('takes the most particular template', () => {
    speak('de', { '{a} of {b}': '{a} von {b}', 'Step {a} of {b}': 'Schritt {a} von {b}' })
    expect(t('Step 2 of 7')).toBe('Schritt 2 von 7')
  })

  it('says sentence by sentence what it has', () => {
    speak('de', { 'It rolls.': 'Sie rollt.', 'It slips.': 'Sie gleitet.' })
    expect(t('It rolls. It slips.')).toBe('Sie rollt. Sie gleitet.')
  })

  it('is soon done with what it does not have, however long that is and however often it seems to know it', () => {
    speak('de', german)
    const links = [' and a ball', ', one on the table', ' to the rim', ' for a disc', ' at rest', ' over the ring']
    const chained = (count: number) => Array.from({ length: count }, (_, i) => links[i % links.length] + i).join('')
    const texts = [30, 60, 90, 400, 4000].map((count) => `Somebody wrote of a coin${chained(count)}.`)
    const began = performance.now()
    for (const text of texts) expect(t(text).length).toBeGreaterThanOrEqual(text.length)
    for (const entry of Object.keys(german)) t(`Somebody wrote: ${entry.replace(/\{\w+\}/g, 'one thing')} too`)
    expect(performance.now() - began).toBeLessThan(20_000) // by one lookup of each part; without, hours
  })

  it('says what is wrong from its parts: the rule, whatever was received, the remedy', () => {
    speak('de', german)
    const told = (key: string, rule: string, received: string, remedy = '') =>
      saidOf({ message: 'anything', key, parts: [{ key, rule, received, remedy }] })
    expect(told('body.radius', 'must be positive', '-1.5')).toBe('`body.radius` muss positiv sein; angegeben ist -1,5.')
    expect(told('support.tilt', 'must lie in (-90 deg, 90 deg)', '172 deg', 'Did you mean 1.72 deg?')).toBe(
      '`support.tilt` muss in (-90°; 90°) liegen; angegeben ist 172°. Meinst du 1,72°?',
    )
    expect(
      told('body.mass', 'must be a mass', "'none of it'", "Write for instance '65 g', or a bare number in kg."),
    ).toBe(
      "`body.mass` muss eine Masse sein; angegeben ist 'none of it'. Schreibe zum Beispiel '65 g', oder eine bloße Zahl in kg.",
    )
  })

  it('takes a comma for a point where a number begins, and shows it so', () => {
    speak('de', { a: 'b' })
    expect(typedDigits('-3,5 cm')).toBe('-3.5 cm')
    expect(typedDigits('min(1, 2)')).toBe('min(1, 2)')
    expect(shownDigits('-3.5')).toBe('-3,5')
  })
})

describe('the language of the page', () => {
  it('is that of the link, else the first of the browser that there is', () => {
    expect(chosenLanguage('?lang=de', ['en-GB'])).toBe('de')
    expect(chosenLanguage('', ['fr', 'de-AT', 'en'])).toBe('de')
    expect(chosenLanguage('?lang=xx', ['fr'])).toBe('en')
    expect(chosenLanguage('', ['pseudo'])).toBe('en')
  })
})

const FILES = import.meta.glob<Catalogue>('./*.json', { import: 'default', eager: true })

describe.each(Object.entries(FILES))('the catalogue %s', (_, catalogue) => {
  const marks = (text: string) => (text.match(/\{\w+\}|\$[^$]+\$/g) ?? []).sort()

  it('keeps what varies, and the formulas', () => {
    for (const [key, said] of Object.entries(catalogue)) expect(marks(said), key).toEqual(marks(key))
  })

  it('has what the German one has', () => {
    expect(Object.keys(german).filter((key) => !(key in catalogue))).toEqual([])
  })
})

it('the pseudo-language marks every word and leaves what varies', () => {
  const strange = pseudo({ 'Show hint {next} of $x$': '' })
  expect(strange).toEqual({ 'Show hint {next} of $x$': '⟦Shóów híínt {next} óóf $x$⟧' })
})

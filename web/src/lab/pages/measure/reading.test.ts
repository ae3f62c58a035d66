import { afterEach, expect, test } from 'vitest'
import { speak } from '../../../languages/translate'
import { clausesSaid } from './reading'

const text = (clauses: string[]) =>
  clausesSaid(clauses)
    .map((node) => node.textContent)
    .join('')

afterEach(() => speak('en', {}))

test('a sentence about a track is said clause by clause, and what stands in the file stays', () => {
  const clauses = ['t from column `time, so to speak` in ms', 'x', 'y in cm', '12 rows', '2 gaps (3 frames)']
  expect(text(clauses)).toBe('t from column time, so to speak in ms, x, y in cm, 12 rows, 2 gaps (3 frames).')
  speak('de', {
    time: 'Zeit',
    't from column `1` in {unit}': 't aus Spalte `1` in {unit}',
    '{count} rows': '{count} Zeilen',
    '{count} gaps ({lost})': '{count} Lücken ({lost})',
    '{count} frames': '{count} Bilder',
    '`1` was left out: {title}': '`1` wurde weggelassen: {title}',
    'its unit is not known: --unit': 'die Einheit ist unbekannt: --unit',
    'Unit of places': 'Einheit der Orte',
  })
  expect(text(clauses)).toBe('t aus Spalte time, so to speak in ms, x, y in cm, 12 Zeilen, 2 Lücken (3 Bilder).')
  expect(text(['t from column `time` in ms'])).toBe('t aus Spalte time in ms.')
  expect(text(['`time` was left out: its unit is not known: --unit'])).toBe(
    'time wurde weggelassen: die Einheit ist unbekannt: “Einheit der Orte”.',
  )
})

test('nothing is said of nothing', () => {
  expect(text([])).toBe('')
})

import { afterEach, expect, it } from 'vitest'
import german from '../../../languages/de.json'
import { speak } from '../../../languages/translate'
import type { Challenge } from '../../api'
import { answerOf } from './challenge'

afterEach(() => speak('en', {}))

it.each(['en', 'de'])('reads a number with a comma or a point, and nothing else, in %s', (language) => {
  speak(language, language === 'de' ? german : {})
  const answering = answerOf({ answer: { kind: 'number', label: 'k' } } as Challenge)
  const box = answering.element!.querySelector('input')!
  const read = (text: string) => {
    box.value = text
    return answering.value()
  }
  expect(['0,4', ' 0.4 ', '−0,25', '.5', '4e-1'].map(read)).toEqual([0.4, 0.4, -0.25, 0.5, 0.4])
  expect(['', 'k', '0,4 kg', '1,2,3', '1e999'].map(read)).toEqual([
    undefined,
    undefined,
    undefined,
    undefined,
    undefined,
  ])
})

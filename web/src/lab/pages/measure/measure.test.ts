import { afterEach, expect, it, vi } from 'vitest'
import german from '../../../languages/de.json'
import { speak } from '../../../languages/translate'
import { createFree } from '.'
import { createReading, type How } from './reading'

afterEach(() => speak('en', {}))

it('takes the noise with the decimal sign of the reader, and shows it so', () => {
  speak('de', german)
  const free = createFree()
  const box = free.element.querySelector<HTMLInputElement>('[data-testid="noise"]')!
  free.show([], [], '0.5 mm')
  expect([box.value, free.value.noise]).toEqual(['0,5 mm', '0.5 mm'])
  box.value = ' 0,25 mm'
  expect(free.value.noise).toBe('0.25 mm')
  box.value = ' '
  expect(free.value.noise).toBeNull()
})

it('offers the numbers by the labels of their controls, with the key beside', () => {
  const ratio = { key: 'body.inertia_ratio', group: 'Body', label: 'Inertia ratio k', value: 0.4, unit: '' }
  const free = createFree()
  free.show([ratio], [ratio.key], '')
  const label = free.element.querySelector<HTMLElement>('.toggle')
  expect([label?.textContent, label?.title]).toEqual(['Body: Inertia ratio k', 'body.inertia_ratio'])
  expect(free.value.keys).toEqual(['body.inertia_ratio'])
})

it('takes what the file does not say with the decimal sign of the reader, and columns as they are', () => {
  speak('de', german)
  const changed = vi.fn<(how: How) => void>()
  const reading = createReading(changed)
  const boxes = new Map(
    [...reading.element.querySelectorAll<HTMLInputElement>('input')].map((box) => [box.placeholder, box]),
  )
  const put = (hint: string, text: string) => {
    const box = boxes.get(hint)!
    box.value = text
    box.dispatchEvent(new Event('change'))
  }
  put('0,8 mm', '0,75 mm')
  expect(changed).toHaveBeenLastCalledWith({ pixel: '0.75 mm' })
  put('t=frame_time, x=u, y=v', '1,5=t')
  expect(changed).toHaveBeenLastCalledWith({ pixel: '0.75 mm', columns: '1,5=t' })
  reading.set({ pixel: '0.75 mm', rate: '59.94' })
  expect([boxes.get('0,8 mm')?.value, boxes.get('60')?.value]).toEqual(['0,75 mm', '59,94'])
})

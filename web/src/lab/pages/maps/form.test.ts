import { afterEach, expect, it, vi } from 'vitest'
import german from '../../../languages/de.json'
import { speak } from '../../../languages/translate'
import type { MapRequest } from '../../api'
import { createForm } from './form'

afterEach(() => speak('en', {}))

const tilt = { key: 'support.tilt', group: 'Support', label: 'Tilt', value: 0.1, unit: 'rad' }
const gravity = { key: 'gravity', group: '', label: 'Gravity', value: 9.81, unit: 'm/s^2' }
const request = {
  scenario: { body: { kind: 'hoop' } },
  over: [
    { key: 'support.tilt', from: '1.5 deg', to: '5 deg', count: 4, scale: 'linear' },
    { key: 'gravity', from: 9.5, to: 10, count: 3, scale: 'linear' },
  ],
  measure: 'max hypot(x, y)',
} as unknown as MapRequest

function setUp() {
  const asked = vi.fn<(request: MapRequest) => void>()
  const form = createForm([], asked)
  document.body.replaceChildren(form.element)
  form.show(request, [tilt, gravity])
  const boxes = [...form.element.querySelectorAll<HTMLInputElement>('fieldset input')]
  return { form, asked, boxes, submit: () => form.element.dispatchEvent(new Event('submit')) }
}

it('shows and takes the decimal sign of the reader, and sends a point', () => {
  speak('de', german)
  const { asked, boxes, submit } = setUp()
  const [from, , , second] = boxes
  expect([from?.value, second?.value]).toEqual(['1,5 deg', '9,5'])
  submit()
  expect(asked.mock.lastCall?.[0].over).toEqual(request.over)
  from!.value = '2,25 deg'
  second!.value = '9,25'
  submit()
  expect(asked.mock.lastCall?.[0].over.map((span) => span.from)).toEqual(['2.25 deg', 9.25])
  expect(asked.mock.lastCall?.[0].measure).toBe('max hypot(x, y)')
})

it('offers the numbers by the labels of their controls, with the key beside', () => {
  const { form } = setUp()
  const [own] = form.element.querySelectorAll('optgroup')
  expect(own?.getAttribute('label')).toBe('Support')
  const offered = [...form.element.querySelectorAll('select')[0]!.options].map((one) => [one.textContent, one.title])
  expect(offered).toEqual([
    ['Tilt (rad)', 'support.tilt'],
    ['Gravity (m/s²)', 'gravity'],
  ])
})

it('says what is wrong in the words of the labels', () => {
  const { form } = setUp()
  form.wrong('over.support.tilt must be an angle.', 'over.support.tilt')
  expect(form.element.querySelector('.map-wrong')?.textContent).toBe('“Support: Tilt” must be an angle.')
})

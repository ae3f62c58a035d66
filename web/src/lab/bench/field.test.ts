import { beforeEach, expect, it, vi } from 'vitest'
import type { Json } from '../scenario'
import { createField } from './field'

const units = { 'rad/s': 1, rpm: Math.PI / 30, 'turn/s': 2 * Math.PI }
const entry = { label: 'Rate', units, unit: 'rpm', min: -10, max: 10, decades: false }

function setUp(value: Json) {
  const change = vi.fn<(value: Json, gesture?: string) => void>()
  const chosen: { unit?: string } = {}
  const field = createField({
    path: 'support.motion.rate',
    entry,
    unit: () => chosen.unit,
    keepUnit: (unit) => {
      chosen.unit = unit
    },
    change,
  })
  field.update(value)
  document.body.replaceChildren(field.element)
  const input = field.element.querySelector<HTMLInputElement>('.field-number')!
  const unit = field.element.querySelector<HTMLSelectElement>('.field-unit')!
  const slider = field.element.querySelector<HTMLInputElement>('.slider')!
  const type = (text: string) => {
    input.value = text
    input.dispatchEvent(new Event('input'))
  }
  const leave = () => input.dispatchEvent(new Event('change'))
  const press = (target: HTMLElement, key: string, init: KeyboardEventInit = {}) =>
    target.dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true, cancelable: true, ...init }))
  return { field, change, chosen, input, unit, slider, type, leave, press }
}

beforeEach(() => document.body.replaceChildren())

it('shows the number as it is written, and its unit beside it', () => {
  const { input, unit, slider } = setUp('33.30 rpm')
  expect([input.value, unit.value]).toEqual(['33.30', 'rpm'])
  expect(slider.getAttribute('aria-valuetext')).toBe('33.30 rpm')
})

it('shows four digits of a number that has many, and all of them to whoever is about to change it', () => {
  const { field, change, input, slider } = setUp('4.999619237890978 rad/s')
  expect(input.value).toBe('5.000')
  expect(slider.getAttribute('aria-valuetext')).toBe('5.000 rad/s')
  input.focus()
  expect([input.value, input.selectionStart, input.selectionEnd]).toEqual(['4.999619237890978', 0, 17])
  input.blur()
  expect([input.value, change.mock.calls]).toEqual(['5.000', []])
  field.update(-2.9942857e-6)
  expect(input.value).toBe('-2.859e-5')
})

it('sends what is typed, with the unit that is shown', () => {
  const { change, type } = setUp('33.3 rpm')
  type('45')
  expect(change).toHaveBeenLastCalledWith('45 rpm', expect.any(String))
})

it('shows a bare number, which is SI, in the unit that it shows', () => {
  const { field, chosen, input, unit, slider } = setUp(45)
  expect([input.value, unit.value]).toEqual(['429.7', 'rpm'])
  expect(slider.getAttribute('aria-valuetext')).toBe('429.7 rpm')
  chosen.unit = 'rad/s'
  field.update(46)
  expect([input.value, unit.value]).toEqual(['46', 'rad/s'])
})

it('shows text without a unit as it stands, since the package refuses it, and gives it the unit shown', () => {
  const { field, change, input, slider, type, leave } = setUp('45')
  expect([input.value, slider.disabled]).toEqual(['45', true])
  field.complain('`support.motion.rate` must be an angular velocity with its unit')
  expect(input.value).toBe('45')
  type('45')
  leave()
  expect(change).toHaveBeenLastCalledWith('45 rpm', expect.any(String))
})

it('takes a unit that is typed, and keeps it', () => {
  const { change, type, leave, chosen, input, unit } = setUp('33.3 rpm')
  type('2 rad/s')
  leave()
  expect(change.mock.calls[0]![0]).toBe('2 rad/s')
  expect(chosen.unit).toBe('rad/s')
  expect([input.value, unit.value]).toEqual(['2', 'rad/s'])
})

it('leaves a unit that it does not know to the server, when the typing is done', () => {
  const { change, type, leave } = setUp('33.3 rpm')
  type('2 revolution/hour')
  expect(change).not.toHaveBeenCalled()
  leave()
  expect(change).toHaveBeenCalledWith('2 revolution/hour', undefined)
})

it('sends nonsense only when the typing is done, so that the package can say what is wrong', () => {
  const { field, change, type, leave, input } = setUp('33.3 rpm')
  type('fast')
  expect(change).not.toHaveBeenCalled()
  leave()
  expect(change).toHaveBeenCalledWith('fast', undefined)
  field.complain('`support.motion.rate` must be an angular velocity')
  const message = document.getElementById(input.getAttribute('aria-describedby')!)
  expect(message?.textContent).toContain('must be an angular velocity')
  expect(input.getAttribute('aria-invalid')).toBe('true')
  field.complain(null)
  expect(input.hasAttribute('aria-invalid')).toBe(false)
})

it('turns the number over when another unit is chosen', () => {
  const { change, unit, chosen } = setUp('30 rpm')
  unit.value = 'turn/s'
  unit.dispatchEvent(new Event('change'))
  expect(chosen.unit).toBe('turn/s')
  expect(change).toHaveBeenCalledWith('0.5 turn/s', undefined)
})

it('steps by the arrow keys, in the box and on the slider', () => {
  const { change, input, slider, press } = setUp('33.3 rpm')
  press(input, 'ArrowUp')
  expect(change.mock.lastCall![0]).toBe('34 rpm')
  press(slider, 'ArrowLeft')
  expect(change.mock.lastCall![0]).toBe('33 rpm')
  press(input, 'ArrowUp', { shiftKey: true })
  expect(change.mock.lastCall![0]).toBe('40 rpm')
  press(input, 'ArrowLeft')
  expect(change).toHaveBeenCalledTimes(3)
})

it('gives round numbers when the slider is dragged, one gesture a drag', () => {
  const { change, slider } = setUp('33.3 rpm')
  for (const place of ['700', '710']) {
    slider.value = place
    slider.dispatchEvent(new Event('input'))
  }
  const [first, second] = change.mock.calls
  expect(first![0]).toMatch(/^3[78](\.\d)? rpm$/)
  expect(first![1]).toBe(second![1])
})

it('has a formula typed over without a slider', () => {
  const { input, slider } = setUp('3.4*(1 - exp(-t))')
  expect(input.value).toBe('3.4*(1 - exp(-t))')
  expect(slider.disabled).toBe(true)
})

/** As the page does: the value goes to the server, which refuses it. */
function refuse({ field, type, leave, change }: ReturnType<typeof setUp>, text: string) {
  type(text)
  leave()
  field.update(change.mock.lastCall![0])
  field.complain('`support.motion.rate` must be an angular velocity')
}

it('goes back to its own unit after one that was refused: the next number is read in it', () => {
  const set = setUp('33.3 rpm')
  refuse(set, '5 kg')
  expect(set.change).toHaveBeenLastCalledWith('5 kg', undefined)
  expect([set.input.value, set.unit.value]).toEqual(['5 kg', 'rpm'])
  expect(set.field.element.querySelector('.field-message')?.textContent).toContain('angular velocity')
  expect([...set.unit.options].map(({ value }) => value)).toEqual(['rpm', 'rad/s', 'turn/s'])
  set.type('45')
  expect(set.change).toHaveBeenLastCalledWith('45 rpm', expect.any(String))
  set.field.update('45 rpm')
  expect([set.input.value, set.unit.value]).toEqual(['45', 'rpm'])
})

it('keeps its unit after nonsense, too', () => {
  const set = setUp('33.3 rpm')
  refuse(set, 'fast')
  expect([set.input.value, set.unit.value]).toEqual(['fast', 'rpm'])
  set.type('45')
  expect(set.change).toHaveBeenLastCalledWith('45 rpm', expect.any(String))
})

it('goes back to the last good value with Escape, from the refused one and from what is typed over it', () => {
  const set = setUp('33.3 rpm')
  set.type('45')
  set.leave()
  set.field.update('45 rpm')
  set.field.accept()
  refuse(set, '5 kg')
  set.press(set.input, 'Escape')
  expect(set.change.mock.lastCall![0]).toBe('45 rpm')
  refuse(set, '6 kg')
  set.type('7')
  set.press(set.input, 'Escape')
  expect(set.change.mock.lastCall![0]).toBe('45 rpm')
  expect([set.input.value, set.unit.value]).toEqual(['45', 'rpm'])
})

it('does not take a refused value for good when the answer to an older one comes after it', () => {
  const set = setUp('33.3 rpm')
  set.type('5 kg')
  set.leave()
  set.field.update('5 kg')
  set.field.accept()
  set.field.complain('`support.motion.rate` must be an angular velocity')
  set.press(set.input, 'Escape')
  expect(set.change.mock.lastCall![0]).toBe('33.3 rpm')
})

it('keeps a unit that only the package knows, once it was accepted', () => {
  const set = setUp('33.3 rpm')
  set.type('2 revolution/hour')
  set.leave()
  set.field.update('2 revolution/hour')
  set.field.accept()
  expect([set.input.value, set.unit.value]).toEqual(['2', 'revolution/hour'])
})

it('ends where it was found to end, says why, and gives no more', () => {
  const { field, change, slider } = setUp('2 rad/s')
  const why = '“Rate” must be at most 5.'
  field.limit({ low: null, high: { value: '5 rad/s', why } })
  slider.value = '1000'
  slider.dispatchEvent(new Event('input'))
  expect(change.mock.calls.at(-1)?.[0]).toBe('5 rad/s')
  const said = field.element.querySelector<HTMLElement>('.field-end')!
  expect([said.hidden, said.textContent]).toEqual([false, `It ends here. ${why}`])
  expect(field.at(1)).toBe('10 rad/s')
})

it('can go nowhere where both ends are where it stands', () => {
  const { field, slider } = setUp('2 rad/s')
  const here = { value: '2 rad/s', why: 'It must roll straight.' }
  field.limit({ low: here, high: here })
  expect([slider.disabled, slider.title]).toEqual([true, 'It must roll straight.'])
  expect(field.element.querySelector('.field-end')?.textContent).toContain('It must roll straight.')
  field.limit({ low: null, high: null })
  expect([slider.disabled, slider.title]).toEqual([false, ''])
})

import { expect, test } from 'vitest'
import { liveShow } from './shown'

test('a switch tells when it is turned, and only then', () => {
  let told = 0
  const show = liveShow({ velocity: true }, () => told++)
  expect([show.velocity, show.trail, show.axes]).toEqual([true, true, false])
  show.axes = true
  show.velocity = true
  expect([told, show.axes]).toEqual([1, true])
})

test('a name that does not exist is refused with those that do', () => {
  const show = liveShow({}, () => undefined) as unknown as Record<string, boolean>
  expect(() => {
    show.speed = true
  }).toThrow(/velocity, contactForce.*got speed/)
})

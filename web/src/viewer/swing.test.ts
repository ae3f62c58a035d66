import { Vector3 } from 'three'
import { expect, test } from 'vitest'
import { Swing } from './swing'

function swung(speed: number, from: number, until: number, every = 16): Swing {
  const swing = new Swing(0.001)
  for (let at = from; at <= until; at += every) swing.add(at, new Vector3((speed * at) / 1000, 0, 0.02))
  return swing
}

test('what a hand lets go of as it moves is thrown at the speed of the hand', () => {
  expect(swung(0.5, 1000, 1160).velocity(1170)?.[0]).toBeCloseTo(0.5, 12)
  const [x, y, z] = swung(-2, 0, 320).velocity(330)!
  expect([x, y, z]).toEqual([expect.closeTo(-2, 12), 0, 0])
})

test('it is also thrown on a page that is busy between two moves', () => {
  for (const every of [90, 101, 130, 250, 480])
    expect(swung(-0.5, 0, 2 * every, every).velocity(2 * every)?.[0]).toBeCloseTo(-0.5, 12)
  expect(swung(-0.5, 0, 1800, 900).velocity(1800), 'a move a second is none').toBeNull()
})

test('what it holds still first is put down', () => {
  expect(swung(0.5, 1000, 1160).velocity(1300)).toBeNull()
  expect(swung(0.005, 1000, 1160).velocity(1170)).toBeNull()
  expect(new Swing(0.001).velocity(5)).toBeNull()
  const once = new Swing(0.001)
  once.add(3, new Vector3(1, 0, 0))
  expect(once.velocity(4)).toBeNull()
})

test('only how it moved at last counts', () => {
  const swing = new Swing(0.001)
  for (let at = 0; at <= 400; at += 20) swing.add(at, new Vector3(at < 200 ? 1 : (at - 200) / 1000, 0, 0))
  expect(swing.velocity(410)?.[0]).toBeCloseTo(1, 9)
})

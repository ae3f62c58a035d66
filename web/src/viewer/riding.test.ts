import { Vector3 } from 'three'
import { expect, test } from 'vitest'
import { circling } from './fixture'
import { materialVelocity, supportTwist } from './riding'
import { unpack } from './scene'
import { Track } from './track'

test('a table’s rate is read off its poses', () => {
  const track = new Track(unpack(circling(21, 1.5)))
  for (const time of [0, 0.33, 1, 2]) {
    const { turning, drift } = supportTwist(track, time)
    expect(turning.z).toBeCloseTo(1.5, 3)
    expect(Math.hypot(turning.x, turning.y, drift.length())).toBeLessThan(1e-6)
  }
})

test('a ball that rides along has no velocity for who rides with it', () => {
  const track = new Track(unpack(circling(21, 1)))
  const twist = supportTwist(track, 0.7)
  const place = track.position(new Vector3())
  const velocity = track.vector('velocity', new Vector3())!
  expect(velocity.sub(materialVelocity(twist, place, new Vector3())).length()).toBeLessThan(2e-3)
})

test('at a given time the track stays where it was sought', () => {
  const track = new Track(unpack(circling(21, 1))).seek(0.7)
  const place = track.position(new Vector3())
  supportTwist(track, 0.7)
  expect(track.position(new Vector3()).distanceTo(place)).toBe(0)
})

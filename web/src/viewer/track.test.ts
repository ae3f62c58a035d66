import { Quaternion, Vector3 } from 'three'
import { expect, test } from 'vitest'
import { circling, packed } from './fixture'
import { unpack } from './scene'
import { hermite, sampleBefore, slerp, Track } from './track'

const turnAbout = (axis: Vector3, angle: number) => new Quaternion().setFromAxisAngle(axis.normalize(), angle)

test('slerp turns at a steady rate about one axis', () => {
  const axis = new Vector3(1, 2, -0.5)
  const [from, to] = [turnAbout(axis, 0.3), turnAbout(axis, 2.1)]
  for (const share of [0, 0.25, 0.5, 0.9, 1]) {
    const found = slerp(from, to, share, new Quaternion())
    expect(found.angleTo(turnAbout(axis, 0.3 + 1.8 * share))).toBeLessThan(1e-7)
  }
})

test('slerp takes the shorter way, and manages turns by nothing at all', () => {
  const to = turnAbout(new Vector3(0, 0, 1), 0.4)
  const away = new Quaternion(-to.x, -to.y, -to.z, -to.w)
  const half = slerp(new Quaternion(), away, 0.5, new Quaternion())
  expect(half.angleTo(turnAbout(new Vector3(0, 0, 1), 0.2))).toBeLessThan(1e-7)
  const same = slerp(to, to.clone(), 0.7, new Quaternion())
  expect(same.angleTo(to)).toBeLessThan(1e-7)
  expect(same.length()).toBeCloseTo(1, 12)
})

test('between coarse samples of a circle the place stays on the circle', () => {
  const track = new Track(unpack(circling(5)))
  const place = new Vector3()
  let worst = 0
  for (let t = 0; t <= 2; t += 0.01) {
    track.seek(t).position(place)
    worst = Math.max(worst, Math.hypot(place.x - Math.cos(t), place.y - Math.sin(t)))
  }
  // The error of a cubic through samples 0.5 apart, h⁴/384; straight lines would be off by h²/8 = 0.03.
  expect(worst).toBeLessThan(0.5 ** 4 / 384 + 1e-5)
})

test('the contact stays under the centre', () => {
  const track = new Track(unpack(circling(5))).seek(0.8)
  const [centre, contact] = [track.position(new Vector3()), track.contact(new Vector3())]
  expect(contact.x).toBeCloseTo(centre.x, 6)
  expect(contact.z).toBeCloseTo(0, 6)
})

test('before the first and after the last sample it stands still', () => {
  const track = new Track(unpack(circling(5)))
  expect(track.seek(-3).position(new Vector3()).x).toBeCloseTo(1, 6)
  expect(track.seek(9).position(new Vector3()).x).toBeCloseTo(Math.cos(2), 6)
  expect(track.sample).toBe(4)
})

test('at an impact the path has a corner: the velocity behind it does not bend the way to it', () => {
  // Falls at 1 m/s, and is thrown up at 1 m/s from t = 1 on; the sample of the impact has the velocity behind it.
  const place = Float32Array.of(0, 0, 1, 0, 0, 0, 0, 0, 1)
  const velocity = Float32Array.of(0, 0, -1, 0, 0, 1, 0, 0, 1)
  const found = hermite(place, velocity, [0, 1, 2], 0, 0.5, new Vector3())
  expect(found.z).toBeCloseTo(0.5, 12)
})

test('one sample is a run, too', () => {
  const scene = unpack(
    packed({
      time: { data: Float64Array.of(3), shape: [1] },
      position: { data: Float32Array.of(1, 2, 3), shape: [1, 3] },
    }),
  )
  const track = new Track(scene).seek(5)
  expect(track.position(new Vector3()).toArray()).toEqual([1, 2, 3])
  expect(track.orientation(new Quaternion()).toArray()).toEqual([0, 0, 0, 1])
  expect(track.vector('contact_force', new Vector3())).toBeNull()
})

test('the sample before a time is found from wherever one looks first', () => {
  const times = Float64Array.of(0, 0.1, 0.4, 0.5, 2, 2.1, 7)
  const slow = (t: number) => {
    let found = 0
    for (let i = 0; i < times.length - 1; i++) if (times[i]! <= t) found = i
    return found
  }
  for (const t of [-1, 0, 0.05, 0.1, 0.45, 1.9, 2.05, 6.9, 7, 8]) {
    for (let hint = 0; hint < times.length; hint++) expect(sampleBefore(times, t, hint)).toBe(slow(t))
  }
})

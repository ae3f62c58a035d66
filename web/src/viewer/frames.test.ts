import { Quaternion, Vector3 } from 'three'
import { expect, test } from 'vitest'
import { circling } from './fixture'
import { framesOf, newPose, nextFrame, seen, viewOf } from './frames'
import { BREAK } from './lines'
import { type Turn, unpack } from './scene'
import { Track } from './track'
import { pathPoints } from './trail'

const LEVEL: Turn = [1, 0, 0, 0]

test('a point of a support that turns and shifts stands still in the corotating frame', () => {
  const mark = new Vector3(0.3, -0.2, 0.1)
  for (const t of [0, 0.4, 1.7, 5]) {
    const support = newPose()
    support.turn.setFromAxisAngle(new Vector3(0.2, 0.1, 1).normalize(), 2 * t)
    support.place.set(Math.sin(t), 0.1 * t, 0)
    const material = seen(support, mark.clone())
    const found = seen(viewOf('corotating', LEVEL, support, newPose()), material)
    expect(found.distanceTo(mark)).toBeLessThan(1e-12)
  }
})

test('the world frame has the vertical upwards: down the slope is down', () => {
  const tilt = 0.2
  const toWorld: Turn = [Math.cos(tilt / 2), 0, Math.sin(tilt / 2), 0]
  const view = viewOf('world', toWorld, newPose(), newPose())
  const slope = seen(view, new Vector3(1, 0, 0))
  expect(slope.z).toBeCloseTo(-Math.sin(tilt), 12)
  expect(slope.x).toBeCloseTo(Math.cos(tilt), 12)
  expect(seen(viewOf('support', toWorld, newPose(), newPose()), new Vector3(1, 0, 0)).z).toBe(0)
})

test('the path on the turning table is the path turned back', () => {
  const scene = unpack(circling(8, 1.5))
  const points = pathPoints(scene, 'corotating')
  for (let i = 0; i < points.length; i += 4) {
    const [x, y, , t] = points.subarray(i, i + 4)
    // Round a circle at rate 1, on a table that turns at 1.5: backwards at 0.5.
    expect(x).toBeCloseTo(Math.cos(-0.5 * t!), 4)
    expect(y).toBeCloseTo(Math.sin(-0.5 * t!), 4)
  }
})

test('points are put between samples where a path bends, and only there', () => {
  const few = pathPoints(unpack(circling(6)), 'support')
  expect(few.length).toBeGreaterThan(4 * 5 * 4) // 0.4 rad from sample to sample
  for (let i = 4; i < few.length; i += 4) {
    const turned = Math.atan2(few[i + 1]!, few[i]!) - Math.atan2(few[i - 3]!, few[i - 4]!)
    expect(turned).toBeLessThan(0.11)
  }
  expect(pathPoints(unpack(circling(41)), 'support').length).toBe(4 * 41)
  expect(pathPoints(unpack(circling(2)), 'support').length).toBe(4 * 7)
})

test('a ball that rides along with the table stays where it is on it', () => {
  const points = pathPoints(unpack(circling(30, 1)), 'corotating')
  for (let i = 0; i < points.length; i += 4) expect(Math.hypot(points[i]! - 1, points[i + 1]!)).toBeLessThan(1e-4)
})

test('the path breaks between rolling and flight, and shows the centre in flight', () => {
  const scene = unpack(circling(5))
  scene.columns.phase!.set([0, 2, 2, 0, 0])
  const points = pathPoints(scene, 'support')
  const breaks = [...points].filter((value, i) => i % 4 === 3 && value > BREAK / 2)
  expect(breaks.length).toBe(2)
  const heights = new Set([...points].filter((_, i) => i % 4 === 2).map((z) => Math.abs(z).toFixed(3)))
  expect([...heights].sort()).toEqual(['0.000', '0.100'])
})

test('the support’s pose between samples is turned in step', () => {
  const track = new Track(unpack(circling(5, 1.5))).seek(0.8)
  const wanted = new Quaternion().setFromAxisAngle(new Vector3(0, 0, 1), 1.2)
  expect(track.supportOrientation(new Quaternion()).angleTo(wanted)).toBeLessThan(1e-6)
})

test('F goes round all three frames', () => {
  expect(nextFrame(nextFrame(nextFrame('world')))).toBe('world')
})

test('only frames that differ are offered', () => {
  const scene = unpack(circling(3))
  expect(framesOf([scene])).toEqual(['world', 'corotating'])
  const fixed = { ...scene, header: { ...scene.header, tilt: 0.1, support: { ...scene.header.support, moves: false } } }
  expect(framesOf([fixed])).toEqual(['world', 'support'])
})

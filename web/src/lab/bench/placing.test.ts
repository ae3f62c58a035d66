import { expect, it } from 'vitest'
import { circling } from '../../viewer/fixture'
import { unpack } from '../../viewer/scene'
import { PARTS, PEA } from '../parts.fixture'
import type { Scenario } from '../scenario'
import { put, whyNotDragged, whyNotNudged } from './placing'

it('writes a place in the unit that was written, and otherwise in that of the coordinate', () => {
  expect(put(PEA, { position: [0.12345678, -0.2] }, PARTS).start.position).toEqual(['12.35 cm', '-20 cm'])
  const hose: Scenario = { ...PEA, support: { kind: 'hose' }, start: { position: [0, '1 mm'] } }
  expect(put(hose, { position: [Math.PI / 2, 0.1] }, PARTS).start.position).toEqual(['90 deg', '100 mm'])
})

it('writes a velocity, keeps its part along the normal, and takes away what goes', () => {
  const start = { ...PEA.start, velocity: [0, '1 cm/s', '3 m/s'], angular_velocity: [0, 0, 1] }
  const next = put({ ...PEA, start }, { velocity: [0.1234, -2], angular_velocity: null }, PARTS)
  expect(next.start.velocity).toEqual(['0.123 m/s', '-200 cm/s', '3 m/s'])
  expect(next.start).not.toHaveProperty('angular_velocity')
})

it('says where nothing can be done by hand', () => {
  const scene = unpack(circling(3))
  const stone = { ...scene, header: { ...scene.header, body: { ...scene.header.body, ball: false } } }
  expect(whyNotNudged(PEA, scene)).toBeNull()
  expect(whyNotNudged(PEA, undefined)).toBeNull()
  expect(whyNotNudged(PEA, stone)).toContain('balls')
  const { support: _, ...path } = PEA
  expect(whyNotDragged(path as Scenario)).toContain('path')
})

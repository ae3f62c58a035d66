import { expect, it } from 'vitest'
import { FIRST } from '../first'
import type { Scenario } from '../scenario'
import type { Instant } from './instant'
import { clockMatters, nudged, placed, thrown, whyNotNudged } from './placing'

const at: Instant = {
  time: 2,
  position: [0.1, -0.2, 0.025],
  contact: [0.1, -0.2, 0],
  velocity: [0.3, 0, 0],
  angularVelocity: [1, 2, 3],
  orientation: [0.5, 0.5, 0.5, 0.5],
}

const on = (support: Scenario['support']): Scenario => ({ ...FIRST, support })

it('puts a dragged ball down in the unit that was written', () => {
  expect(placed(FIRST, [0.12345678, -0.2, 0.025]).start.position).toEqual(['12.35 cm', '-20 cm'])
})

it('says a place in a cylinder by angle and height, in a tube by two angles', () => {
  expect(placed(on({ kind: 'cylinder', radius: '40 cm' }), [0, 0.4, 0.1]).start.position).toEqual(['90 deg', '10 cm'])
  const tube = on({ kind: 'torus-track', ring_radius: '40 cm', tube_radius: '10 cm' })
  expect(placed(tube, [0.5, 0, 0]).start.position).toEqual(['0 deg', '90 deg'])
  expect(placed(tube, [0, 0.4, -0.1]).start.position).toEqual(['90 deg', '0 deg'])
  expect(placed(on({ ...tube.support, side: 'outside' }), [0.4, 0, 0.1]).start.position).toEqual(['0 deg', '0 deg'])
})

it('throws it with the velocity drawn; what turned with the old one goes where it cannot slip', () => {
  const turning: Scenario = { ...FIRST, start: { ...FIRST.start, angular_velocity: [0, 0, 1] } }
  expect(thrown(turning, 0.1234, -2).start).toMatchObject({ velocity: ['0.123 m/s', '-2 m/s'] })
  expect(thrown(turning, 0.1, 0).start).not.toHaveProperty('angular_velocity')
  const slipping = { ...turning, support: { ...turning.support, friction: 0.2 } }
  expect(thrown(slipping, 0.1, 0).start).toHaveProperty('angular_velocity')
})

it('goes on from the instant of a nudge: rolling with its spin, or slipping with all of its turning', () => {
  expect(nudged(FIRST, at, 0.1, -0.1).start).toEqual({
    position: [0.1, -0.2],
    velocity: [0.4, -0.1],
    orientation: [0.5, 0.5, 0.5, 0.5],
    spin: 3,
  })
  const slipping = on({ ...FIRST.support, friction: 0.2 })
  expect(nudged(slipping, at, 0, 0).start).toMatchObject({ velocity: [0.3, 0], angular_velocity: [1, 2, 3] })
})

it('says where a nudge makes no sense, and where the clock begins anew', () => {
  expect(whyNotNudged(FIRST)).toBeNull()
  expect(whyNotNudged(on({ kind: 'bowl', radius: '40 cm' }))).toContain('table')
  expect(whyNotNudged({ ...FIRST, body: { kind: 'disc' } })).toContain('balls')
  expect(clockMatters(FIRST)).toBe(false)
  expect(clockMatters(on({ kind: 'plane', motion: { kind: 'spin-by', rate: 't' } }))).toBe(true)
})

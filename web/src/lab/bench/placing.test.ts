import { expect, it } from 'vitest'
import type { Triple } from '../../viewer/scene'
import { FIRST } from '../first'
import type { Scenario } from '../scenario'
import type { Instant } from './instant'
import { clockMatters, nudged, placed, thrown, whyNotHere, whyNotNudged } from './placing'
import type { Pose, Spot } from './surfaces'

const at: Instant = {
  time: 2,
  position: [0.1, -0.2, 0.025],
  contact: [0.1, -0.2, 0],
  velocity: [0.3, 0, 0],
  angularVelocity: [1, 2, 3],
  orientation: [0.5, 0.5, 0.5, 0.5],
  own: [],
}

const lies = (contact: Triple): Spot => ({ position: contact, contact, normal: [0, 0, 1] })

const on = (support: Scenario['support']): Scenario => ({ ...FIRST, support })

it('puts a dragged ball down in the unit that was written', () => {
  expect(placed(FIRST, lies([0.12345678, -0.2, 0.025])).start.position).toEqual(['12.35 cm', '-20 cm'])
})

it('says a place in a cylinder by angle and height, in a tube by two angles', () => {
  const pipe = on({ kind: 'cylinder', radius: '40 cm' })
  expect(placed(pipe, lies([0, 0.4, 0.1])).start.position).toEqual(['90 deg', '10 cm'])
  const tube = on({ kind: 'torus-track', ring_radius: '40 cm', tube_radius: '10 cm' })
  expect(placed(tube, lies([0.5, 0, 0])).start.position).toEqual(['0 deg', '90 deg'])
  expect(placed(tube, lies([0, 0.4, -0.1])).start.position).toEqual(['90 deg', '0 deg'])
  const outside = on({ ...tube.support, side: 'outside' })
  expect(placed(outside, lies([0.4, 0, 0.1])).start.position).toEqual(['0 deg', '0 deg'])
})

it('throws it with the velocity drawn; what turned with the old one goes where it cannot slip', () => {
  const turning: Scenario = { ...FIRST, start: { ...FIRST.start, angular_velocity: [0, 0, 1] } }
  expect(thrown(turning, at, [0.1234, -2, 0]).start).toMatchObject({ velocity: ['0.123 m/s', '-2 m/s'] })
  expect(thrown(turning, at, [0.1, 0, 0]).start).not.toHaveProperty('angular_velocity')
  const slipping = { ...turning, support: { ...turning.support, friction: 0.2 } }
  expect(thrown(slipping, at, [0.1, 0, 0]).start).toHaveProperty('angular_velocity')
})

it('goes on from the instant of a nudge: rolling with its spin, or slipping with all of its turning', () => {
  expect(nudged(FIRST, at, [0.1, -0.1, 0]).start).toEqual({
    position: [0.1, -0.2],
    velocity: [0.4, -0.1],
    orientation: [0.5, 0.5, 0.5, 0.5],
    spin: 3,
  })
  const slipping = on({ ...FIRST.support, friction: 0.2 })
  expect(nudged(slipping, at, [0, 0, 0]).start).toMatchObject({ velocity: [0.3, 0], angular_velocity: [1, 2, 3] })
})

it('says where a nudge makes no sense, and where the clock matters', () => {
  expect(whyNotNudged(FIRST)).toBeNull()
  expect(whyNotNudged(on({ kind: 'bowl', radius: '40 cm' }))).toBeNull()
  expect(whyNotNudged({ ...FIRST, body: { kind: 'disc' } })).toContain('balls')
  expect(clockMatters(FIRST)).toBe(false)
  expect(clockMatters(on({ kind: 'plane', motion: { kind: 'spin-by', rate: 't' } }))).toBe(true)
  expect(clockMatters(on({ kind: 'height-field', formula: 'x*y', motion: { kind: 'spin', rate: 1 } }))).toBe(true)
  expect(clockMatters({ ...FIRST, loads: [{ kind: 'force', value: [0, '0.1*sin(3*t)', 0] }] })).toBe(true)
  expect(clockMatters({ ...FIRST, loads: [{ kind: 'torque', value: [0, '0.1 N m', 0] }] })).toBe(false)
})

// A ball of 10 cm in a bowl of 50 cm, 30° up its side: by hand, (b sin α, b(1 − cos α)) and the normal (−sin α, cos α).
const [sine, cosine] = [0.5, Math.sqrt(3) / 2]
const bowl = on({ kind: 'bowl', radius: '50 cm' })
const upTheSide: Instant = {
  ...at,
  contact: [0.5 * sine, 0, 0.5 * (1 - cosine)],
  position: [0.4 * sine, 0, 0.5 - 0.4 * cosine],
  velocity: [0.2 * cosine, 0.3, 0.2 * sine],
  angularVelocity: [-2 * sine, 7, 2 * cosine],
}

it('says a place in a bowl by x and y of the contact, not of the centre', () => {
  expect(placed(bowl, upTheSide).start.position).toEqual(['25 cm', '0 cm'])
})

it('says a velocity by its two components along the surface', () => {
  const drawn: Triple = [0.4 * cosine, -0.1, 0.4 * sine]
  expect(thrown(bowl, upTheSide, drawn).start.velocity).toEqual(['0.4 m/s', '-0.1 m/s'])
})

it('goes on in a bowl with the spin about its normal there', () => {
  const { start } = nudged(bowl, upTheSide, [0, 0.5, 0])
  expect(start).toMatchObject({ position: [0.25, 0], velocity: [0.2, 0.8] })
  expect(start.spin).toBeCloseTo(2, 8)
})

it('says that no run can start where the surface overhangs', () => {
  const above: Instant = {
    ...upTheSide,
    contact: [0.5 * sine, 0, 0.5 * (1 + cosine)],
    position: [0.2, 0, 0.5 + 0.4 * cosine],
  }
  expect(whyNotHere(bowl, upTheSide)).toBeNull()
  expect(whyNotHere(bowl, above)).toContain('overhangs')
  expect(whyNotHere(on({ kind: 'cylinder', radius: '50 cm', tilt: '90 deg' }), above)).toBeNull()
})

it('goes on in flight from its height, with all of its turning', () => {
  const flying: Instant = { ...at, height: 0.3, position: [0.1, -0.2, 0.325], velocity: [0.3, 0, -1] }
  expect(nudged(FIRST, flying, [0, 0.1, 0]).start).toMatchObject({
    velocity: [0.3, 0.1, -1],
    height: 0.3,
    angular_velocity: [1, 2, 3],
  })
})

const half = Math.SQRT1_2
const quarter: Pose = { place: [0, 0, 0], turn: [half, 0, 0, half] }

it('goes on by the clock of what moves, in the coordinates of the support as it stands then', () => {
  const hills = on({ kind: 'height-field', formula: '0.1*x', motion: { kind: 'spin', rate: 1 } })
  const turned: Instant = { ...at, contact: [0, 0.2, 0], position: [0, 0.2, 0.025], support: quarter }
  const { start } = nudged(hills, turned, [0, 0.1, 0])
  expect(start).toMatchObject({ time: 2, position: [0.2, 0], velocity: [0.1, -0.3], orientation: at.orientation })
  const free = on({ kind: 'plane', motion: { kind: 'free-axle', inertia: 1, rate: 1 } })
  const own = { ...turned, own: [0.5, 1.25] }
  expect(nudged(free, own, [0, 0, 0]).start).toMatchObject({ time: 2, support: [0.5, 1.25], spin: 3 })
})

it('leaves the clock alone where nothing goes by it', () => {
  const table = on({ kind: 'plane', motion: { kind: 'spin', rate: 1 } })
  const turned: Instant = { ...at, contact: [0, 0.2, 0], position: [0, 0.2, 0.025], support: quarter }
  const { start } = nudged(table, turned, [0, 0.1, 0])
  expect(start).toMatchObject({ position: [0, 0.2], velocity: [0.3, 0.1], spin: 3 })
  expect(start).not.toHaveProperty('time')
  const later = { ...table, start: { ...table.start, time: '3 s' } }
  expect(nudged(later, turned, [0, 0, 0], quarter).start).toMatchObject({ time: '3 s', position: [0.2, 0] })
})

/** Starts by hand: where the ball was dragged, the velocity drawn, and a restart from the middle of a run. */
import { Vector3 } from 'three'
import type { Triple } from '../../viewer/scene'
import { type Kind, parse, rounded, UNITS, write } from '../quantity'
import type { Json, Quantity, Scenario, Table } from '../scenario'
import { withValue } from '../scenario'
import { ROUND } from './defaults'
import type { Instant } from './instant'
import { coordinates, directions, looksAlike, type Own, own, type Pose, type Spot, sayable } from './surfaces'

/** Why the ball cannot be dragged here, or null where it can. */
export function whyNotDragged(scenario: Scenario): string | null {
  return scenario.support ? null : 'A ball that is rolled along a path starts where the path does.'
}

/** Without what is left of a zero that was turned to and fro. */
const clean = (value: number): number => (Math.abs(value) < 1e-12 ? 0 : value)

/** The quantity in the unit in which the start says it now. */
function worded(scenario: Scenario, key: string, index: number, si: number, kind: Kind, usual: string): Quantity {
  const vector = scenario.start[key]
  const { unit } = parse(Array.isArray(vector) ? vector[index] : undefined)
  return write(clean(si), kind, unit in UNITS[kind] ? unit : usual, key === 'velocity' ? 3 : 4)
}

const ANGLES: Record<string, readonly [boolean, boolean]> = { cylinder: [true, false], 'torus-track': [true, true] }

/** The scenario with its start at a place on the support, in the coordinates that the surface has. */
export function placed(scenario: Scenario, spot: Spot, start?: Pose): Scenario {
  const angles = ANGLES[scenario.support.kind] ?? [false, false]
  const pair = coordinates(scenario.support, own(scenario, spot, start)).map((si, index) =>
    angles[index]
      ? worded(scenario, 'position', index, si, 'angle', 'deg')
      : worded(scenario, 'position', index, si, 'length', 'cm'),
  )
  return withValue(scenario, 'start.position', pair)
}

/** The components of a velocity of the support frame along the surface, as a start says them. */
function along(scenario: Scenario, there: Own, velocity: Vector3): [number, number] {
  const [first, second] = directions(scenario.support, there)
  const turned = velocity.clone().applyQuaternion(there.turn)
  return [turned.dot(first), turned.dot(second)]
}

/** The scenario with another first velocity, drawn along the surface. */
export function thrown(scenario: Scenario, spot: Spot, velocity: Triple, start?: Pose): Scenario {
  const there = own(scenario, spot, start)
  const before = scenario.start.velocity
  const pair: Json[] = along(scenario, there, new Vector3(...velocity)).map((speed, index) =>
    worded(scenario, 'velocity', index, speed, 'velocity', 'm/s'),
  )
  const third = Array.isArray(before) && before.length === 3 ? before.slice(2) : []
  const next = withValue(scenario, 'start.velocity', [...pair, ...third])
  if (!Array.isArray(scenario.start.angular_velocity) || scenario.support.friction !== undefined) return next
  // Nothing slips here, so an angular velocity that went with the old velocity would contradict the new one.
  return withValue(next, 'start.angular_velocity', undefined)
}

const exact = (value: number): number => rounded(clean(value), 9)

/**
 * The scenario that goes on from an instant, its velocity changed by a nudge. Where the support grips as much
 * as it takes the ball rolls on at once, with the spin it had; else the nudge goes through its centre and
 * leaves its turning as it was. What moves by the clock goes on by it.
 */
export function nudged(scenario: Scenario, at: Instant, by: Triple, begin?: Pose): Scenario {
  const clock = clockMatters(scenario)
  const there = own(scenario, at, clock ? at.support : begin)
  const velocity = new Vector3(...at.velocity)
  const upwards = velocity.clone().applyQuaternion(there.turn).dot(there.normal)
  const turning = new Vector3(...at.angularVelocity)
  const flies = at.height !== undefined
  const parts = along(scenario, there, velocity.add(new Vector3(...by)))
  const start: Table = {
    position: coordinates(scenario.support, there).map(exact),
    velocity: [...parts, ...(flies ? [upwards] : [])].map(exact),
    orientation: at.orientation.map(exact),
  }
  if (clock) start.time = exact(at.time)
  else if (scenario.start.time !== undefined) start.time = scenario.start.time
  if (clock && at.own.length) start.support = at.own.map(exact)
  if (flies) start.height = exact(at.height ?? 0)
  if (flies || scenario.support.friction !== undefined) start.angular_velocity = at.angularVelocity.map(exact)
  else start.spin = exact(turning.applyQuaternion(there.turn).dot(there.normal))
  return { ...scenario, start }
}

/** Why no run can start where the ball is, or null where one can. */
export function whyNotHere(scenario: Scenario, spot: Spot, begin?: Pose): string | null {
  if (sayable(scenario.support, own(scenario, spot, begin))) return null
  return 'No run can start here: a start says its place by x and y, and the surface overhangs.'
}

/** Why a run cannot be nudged, or null where it can. */
export function whyNotNudged(scenario: Scenario): string | null {
  const why = whyNotDragged(scenario)
  if (why) return why
  if (!ROUND.has(scenario.body.kind)) return 'Nudging is for balls whose centre of mass is in the middle.'
  return null
}

/** Does it matter when a run starts, since the support or a load is not what it was at the start? */
export function clockMatters(scenario: Scenario): boolean {
  const kind = scenario.support?.motion?.kind ?? 'fixed'
  const varies = /\bt\b/.test(JSON.stringify(scenario.loads ?? []))
  return varies || (kind !== 'fixed' && !(kind === 'spin' && looksAlike(scenario)))
}

/** Starts by hand: where the ball was dragged, the velocity drawn, and a restart from the middle of a run. */
import type { Triple } from '../../viewer/scene'
import { parse, rounded, toSI, UNITS, write } from '../quantity'
import type { Json, Quantity, Scenario, Table } from '../scenario'
import { withValue } from '../scenario'
import { ROUND } from './defaults'
import type { Instant } from './instant'

/** Why the ball cannot be dragged here, or null where it can. */
export function whyNotDragged(scenario: Scenario): string | null {
  return scenario.support ? null : 'A ball that is rolled along a path starts where the path does.'
}

function unitOf(value: Json | undefined, fallback: string): string {
  const unit = parse(value).unit
  return unit in UNITS.length || unit in UNITS.velocity ? unit : fallback
}

function component(scenario: Scenario, key: string, index: number): Json | undefined {
  const vector = scenario.start[key]
  return Array.isArray(vector) ? vector[index] : undefined
}

const length = (metres: number, unit: string): Quantity => write(metres, 'length', unit || 'm', 4)

/** The scenario with its start at a place of the support frame, in the coordinates that the surface has. */
export function placed(scenario: Scenario, [x, y, z]: Triple): Scenario {
  const { kind } = scenario.support
  if (kind === 'torus-track') return withValue(scenario, 'start.position', tubeAngles(scenario.support, [x, y, z]))
  if (kind === 'cylinder') {
    const unit = unitOf(component(scenario, 'position', 1), 'cm')
    return withValue(scenario, 'start.position', [degrees(Math.atan2(y, x)), length(z, unit)])
  }
  const units = [0, 1].map((index) => unitOf(component(scenario, 'position', index), 'cm'))
  return withValue(scenario, 'start.position', [length(x, units[0] ?? 'cm'), length(y, units[1] ?? 'cm')])
}

const degrees = (radians: number): Quantity => write(radians, 'angle', 'deg', 4)

/** The angle about the axis, and the one around the tube: 0 where a body comes to rest, growing outwards. */
function tubeAngles(support: Table, [x, y, z]: Triple): Json[] {
  const outwards = Math.hypot(x, y) - (toSI(support.ring_radius, 'length') ?? 0)
  const down = support.side === 'outside' ? z : -z
  return [degrees(Math.atan2(y, x)), degrees(Math.atan2(outwards, down))]
}

/** The scenario with another first velocity, along x and y. */
export function thrown(scenario: Scenario, vx: number, vy: number): Scenario {
  const units = [0, 1].map((index) => unitOf(component(scenario, 'velocity', index), 'm/s'))
  const pair = [vx, vy].map((speed, index) => write(speed, 'velocity', units[index] || 'm/s', 3))
  const next = withValue(scenario, 'start.velocity', pair)
  if (!Array.isArray(scenario.start.angular_velocity) || scenario.support.friction !== undefined) return next
  // Nothing slips here, so an angular velocity that went with the old velocity would contradict the new one.
  return withValue(next, 'start.angular_velocity', undefined)
}

const exact = (value: number): number => rounded(value, 9)

/**
 * The scenario that goes on from an instant, its velocity changed by a nudge. Where the support grips as much
 * as it takes the ball rolls on at once, with the spin it had; else the nudge goes through its centre and
 * leaves its turning as it was. Only for balls on a plane: elsewhere a place is said otherwise.
 */
export function nudged(scenario: Scenario, at: Instant, vx: number, vy: number): Scenario {
  const [x, y, z] = at.position
  const [u, v, w] = at.velocity
  const flies = z - at.contact[2] > 1.02 * Math.abs(z) && z > 0
  const start: Table = {
    position: [exact(x), exact(y)],
    velocity: [exact(u + vx), exact(v + vy), ...(flies ? [exact(w)] : [])],
    orientation: at.orientation.map(exact),
  }
  if (scenario.support.friction === undefined) start.spin = exact(at.angularVelocity[2])
  else start.angular_velocity = at.angularVelocity.map(exact)
  return { ...scenario, start }
}

/** Why a run cannot be nudged, or null where it can. */
export function whyNotNudged(scenario: Scenario): string | null {
  if (scenario.support?.kind !== 'plane') return 'Nudging is for balls on a table.'
  if (!ROUND.has(scenario.body.kind)) return 'Nudging is for balls whose centre of mass is in the middle.'
  return null
}

/** Does the support's motion depend on the clock, so that a restart begins it anew? */
export function clockMatters(scenario: Scenario): boolean {
  const kind = scenario.support?.motion?.kind ?? 'fixed'
  return !['fixed', 'spin'].includes(kind)
}

export function speedOf([x, y, z]: Triple): number {
  return Math.hypot(x, y, z)
}

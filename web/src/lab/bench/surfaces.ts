/** Places on a surface in the coordinates that it has: see docs/surfaces.md. Geometry only, of places that were picked. */
import { Quaternion, Vector3 } from 'three'
import type { Triple, Turn } from '../../viewer/scene'
import { toSI } from '../quantity'
import type { Scenario, Table } from '../scenario'

/** Where the support's material is, and how it is turned, in the support frame. */
export interface Pose {
  place: Triple
  turn: Turn
}

/** A body on its support at some instant, in the support frame. */
export interface Spot {
  position: Triple
  contact: Triple
  /** Absent: from the contact to the centre, as it is for a ball. */
  normal?: Triple
  /** Absent where the support does not move. */
  support?: Pose | undefined
}

/** The same in the frame in which a run begins: that of the support's material, whose pose is then `start`. */
export interface Own {
  position: Vector3
  contact: Vector3
  normal: Vector3
  /** Takes vectors of the support frame to this frame. */
  turn: Quaternion
}

const TURNING = new Set(['fixed', 'spin', 'uneven-spin', 'spin-by', 'free-axle'])
const UNEVEN = new Set(['ellipsoidal-bowl', 'height-field'])

/** Does the surface lie where it was, however far it has turned about its axis? */
export function looksAlike({ support }: Scenario): boolean {
  return TURNING.has(support?.motion?.kind ?? 'fixed') && !UNEVEN.has(support?.kind)
}

const vector = (triple: Triple): Vector3 => new Vector3(...triple)
const quaternion = ([w, x, y, z]: Turn): Quaternion => new Quaternion(x, y, z, w)
const STILL: Pose = { place: [0, 0, 0], turn: [1, 0, 0, 0] }

export function own(scenario: Scenario, spot: Spot, start: Pose = STILL): Own {
  const pose = looksAlike(scenario) ? start : (spot.support ?? start)
  const turn = quaternion(pose.turn).conjugate()
  const there = (triple: Triple) => vector(triple).sub(vector(pose.place)).applyQuaternion(turn)
  const [position, contact] = [there(spot.position), there(spot.contact)]
  const normal = spot.normal ? vector(spot.normal).applyQuaternion(turn) : position.clone().sub(contact)
  return { position, contact, normal: normal.normalize(), turn }
}

/** The two coordinates, in m or rad. */
export function coordinates(support: Table, { position, contact }: Own): [number, number] {
  const { x, y, z } = contact
  if (support.kind === 'plane') return [position.x, position.y]
  if (support.kind === 'cylinder') return [Math.atan2(y, x), z]
  if (support.kind === 'torus-track')
    return [Math.atan2(y, x), Math.atan2(outwards(support, contact), z * rest(support))]
  return [x, y]
}

/** From the middle of a tube towards its line of rest: the lowest inside, the highest outside. */
const rest = (support: Table): 1 | -1 => (support.side === 'outside' ? 1 : -1)

function outwards(support: Table, { x, y }: Vector3): number {
  return Math.hypot(x, y) - (toSI(support.ring_radius, 'length') ?? 0)
}

/** Where a surface overhangs, x and y stand for a place on its other part: no start can be said to lie there. */
export function sayable({ kind }: Table, { normal }: Own): boolean {
  return kind === 'plane' || kind === 'cylinder' || kind === 'torus-track' || normal.z > 0
}

/** The two unit tangents along which the velocity of a start is given. */
export function directions(support: Table, { contact, normal: n }: Own): [Vector3, Vector3] {
  if (support.kind === 'plane') return [new Vector3(1, 0, 0), new Vector3(0, 1, 0)]
  if (support.kind !== 'cylinder' && support.kind !== 'torus-track') {
    const first = new Vector3(n.z, 0, -n.x).normalize()
    return [first, n.clone().cross(first)]
  }
  const away = new Vector3(contact.x, contact.y, 0).normalize()
  const around = new Vector3(-away.y, away.x, 0)
  if (support.kind === 'cylinder') return [around, new Vector3(0, 0, 1)]
  const [out, up] = [outwards(support, contact), contact.z]
  const second = away.multiplyScalar(up).sub(new Vector3(0, 0, out))
  return [around, second.multiplyScalar(rest(support)).normalize()]
}

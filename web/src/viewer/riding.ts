/** How the support moves, read off its poses: what somebody who rides on it does not see of a body's motion. */
import { Quaternion, Vector3 } from 'three'
import { typicalSize } from './quantities'
import type { Scene } from './scene'
import { Track } from './track'

export interface Twist {
  /** Angular velocity, rad/s, and the velocity of the support's material at its origin, m/s, in the support frame. */
  readonly turning: Vector3
  readonly drift: Vector3
  readonly origin: Vector3
}

const before = new Quaternion()
const after = new Quaternion()
const start = new Vector3()

/** The motion of the support about a time: over a step of the samples, within which its pose is interpolated. */
export function supportTwist(track: Track, time: number): Twist {
  const step = Math.min(1e-3, (track.end - track.begin) / 1e4) || 1e-3
  const early = Math.max(time - step, track.begin)
  const late = Math.min(time + step, track.end)
  const passed = late - early || 1
  track.seek(early)
  track.supportOrientation(before)
  track.supportPosition(start)
  track.seek(late)
  const drift = track.supportPosition(new Vector3()).sub(start).divideScalar(passed)
  const turn = track.supportOrientation(after).multiply(before.conjugate())
  if (turn.w < 0) turn.set(-turn.x, -turn.y, -turn.z, -turn.w)
  const turning = new Vector3(turn.x, turn.y, turn.z)
  const sine = turning.length()
  if (sine > 0) turning.multiplyScalar((2 * Math.atan2(sine, turn.w)) / sine / passed)
  track.seek(time)
  return { turning, drift, origin: track.supportPosition(new Vector3()) }
}

/** The velocity of the support's material at a place of the support frame. */
export function materialVelocity({ turning, drift, origin }: Twist, place: Vector3, out: Vector3): Vector3 {
  return out.copy(place).sub(origin).cross(turning).negate().add(drift)
}

const SOME = 200

/** A typical large speed of a body as somebody sees it who rides on the support, m/s. */
export function typicalRidingSpeed(scene: Scene): number {
  if (!scene.columns.velocity) return 0
  const track = new Track(scene)
  const found = new Float32Array(3 * SOME)
  const place = new Vector3()
  const velocity = new Vector3()
  const material = new Vector3()
  for (let i = 0; i < SOME; i++) {
    const time = track.begin + ((track.end - track.begin) * i) / (SOME - 1)
    const twist = supportTwist(track, time)
    track.position(place)
    track.vector('velocity', velocity)
    velocity.sub(materialVelocity(twist, place, material)).toArray(found, 3 * i)
  }
  return typicalSize(found)
}

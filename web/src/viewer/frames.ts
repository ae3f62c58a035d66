/** Who looks: how places of the inertial support frame are turned and moved into the frame that is shown. */
import { Quaternion, Vector3 } from 'three'
import type { Frame } from './contract'
import type { Scene, Turn } from './scene'

export const FRAMES: readonly Frame[] = ['world', 'support', 'corotating']

export const FRAME_NAMES: Record<Frame, { short: string; long: string }> = {
  world: { short: 'World', long: 'Beside the support, the vertical upwards' },
  support: { short: 'Support', long: 'Beside the support, its axis upwards' },
  corotating: { short: 'Riding', long: 'On the support, moving with it' },
}

/** Where the support's material is, seen in the support frame. */
export interface Pose {
  readonly turn: Quaternion
  readonly place: Vector3
}

/** The map from the support frame to a shown frame: x ↦ turn x + place. */
export function viewOf(frame: Frame, toWorld: Turn, support: Pose, out: Pose): Pose {
  out.place.set(0, 0, 0)
  if (frame === 'support') out.turn.identity()
  else if (frame === 'world') out.turn.set(toWorld[1], toWorld[2], toWorld[3], toWorld[0])
  else {
    out.turn.copy(support.turn).conjugate()
    out.place.copy(support.place).applyQuaternion(out.turn).negate()
  }
  return out
}

export function seen(view: Pose, place: Vector3): Vector3 {
  return place.applyQuaternion(view.turn).add(view.place)
}

export function newPose(): Pose {
  return { turn: new Quaternion(), place: new Vector3() }
}

/** The frames that differ for some of these scenes: a level table has its axis upwards, a fixed one carries nobody. */
export function framesOf(scenes: readonly Scene[]): Frame[] {
  const tilted = scenes.some(({ header }) => header.tilt !== 0)
  const moving = scenes.some(({ header }) => header.support.moves)
  return FRAMES.filter((frame) => frame === 'world' || (frame === 'support' ? tilted : moving))
}

export function nextFrame(frame: Frame): Frame {
  return FRAMES[(FRAMES.indexOf(frame) + 1) % FRAMES.length]!
}

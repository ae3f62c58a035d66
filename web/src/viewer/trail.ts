/** The paths that bodies leave, in the frame that is shown: drawn up to now, fading behind. */
import { Vector3 } from 'three'
import type { Frame } from './contract'
import { newPose, type Pose, viewOf } from './frames'
import { BREAK } from './lines'
import { PHASE, type Scene, type Turn } from './scene'
import { Track } from './track'

const MOST_POINTS = 10_000
const MOST_BREAKS = 1000
const MOST_BETWEEN = 6 // points put between two samples, where the path bends
const BEND = 0.08 // rad, that a path may turn from one point to the next

/**
 * The path of the contact on the support, and of the centre in flight, as x, y, z, t.
 *
 * In `corotating` the points are those of the support's material; otherwise those of the support frame, whichever of
 * the two inertial frames is shown.
 */
export function pathPoints(scene: Scene, frame: Frame, of: 'body' | 'guiding_centre' = 'body'): Float32Array {
  const { time, phase } = scene.columns
  const flies = (i: number) => of === 'body' && phase?.[i] === PHASE.flight
  const placeAt = places(scene, frame, of)
  const place = new Vector3()
  const samples = new Float32Array(3 * time.length)
  for (let i = 0; i < time.length; i++) placeAt(time[i]!, flies(i), place).toArray(samples, 3 * i)
  const most = Math.min(MOST_BETWEEN, Math.max(1, Math.floor(MOST_POINTS / Math.max(time.length, 1))))
  const out = new Float32Array(4 * (time.length * most + MOST_BREAKS))
  let filled = 0
  const put = ({ x, y, z }: Vector3, t: number) => {
    if (filled + 4 > out.length || !Number.isFinite(x + y + z)) return
    out[filled++] = x
    out[filled++] = y
    out[filled++] = z
    out[filled++] = t
  }
  for (let i = 0; i < time.length; i++) {
    // Between touching and flying it goes from the contact to the centre, which is no path.
    if (i > 0 && flies(i) !== flies(i - 1)) put(place.set(0, 0, 0), BREAK)
    put(place.fromArray(samples, 3 * i), time[i]!)
    const parts = i + 1 < time.length ? partsAt(samples, i, most) : 1
    for (let k = 1; k < parts; k++) {
      const t = time[i]! + (k / parts) * (time[i + 1]! - time[i]!)
      put(placeAt(t, flies(i), place), t)
    }
  }
  return out.slice(0, filled)
}

/** Where a path is at a time; not a number where there is none. */
function places(
  scene: Scene,
  frame: Frame,
  of: 'body' | 'guiding_centre',
): (time: number, flying: boolean, out: Vector3) => Vector3 {
  const track = new Track(scene)
  const toMaterial = frame === 'corotating' ? materialFrame() : null
  return (time, flying, out) => {
    track.seek(time)
    if (of === 'guiding_centre') {
      if (!track.vector('guiding_centre', out)) return out.setScalar(Number.NaN)
    } else if (flying) track.position(out)
    else track.contact(out)
    toMaterial?.(track, out)
    return out
  }
}

/** Into how many parts the way from sample i to the next is to be cut: many where the path turns at either end. */
function partsAt(samples: Float32Array, i: number, most: number): number {
  if (samples.length < 9) return most // two samples alone do not tell
  const turned = Math.max(turnAt(samples, i), turnAt(samples, i + 1))
  return turned < most * BEND ? Math.max(1, Math.ceil(turned / BEND)) : most
}

/** By how much a path of samples turns at one of them, rad; not at its ends. */
function turnAt(samples: Float32Array, i: number): number {
  const at = 3 * i
  if (i < 1 || at + 5 >= samples.length) return 0
  let [dot, before, after] = [0, 0, 0]
  for (let k = at; k < at + 3; k++) {
    const u = samples[k]! - samples[k - 3]!
    const v = samples[k + 3]! - samples[k]!
    dot += u * v
    before += u * u
    after += v * v
  }
  return before > 0 && after > 0 ? Math.acos(Math.min(1, Math.max(-1, dot / Math.sqrt(before * after)))) : 0
}

const LEVEL: Turn = [1, 0, 0, 0]

function materialFrame(): (track: Track, place: Vector3) => void {
  const support = newPose()
  const view: Pose = newPose()
  return (track, place) => {
    track.supportOrientation(support.turn)
    track.supportPosition(support.place)
    viewOf('corotating', LEVEL, support, view)
    place.applyQuaternion(view.turn).add(view.place)
  }
}

/** How long ago a piece of path is when it has mostly faded, s: longer for a run in which little happens at once. */
export function fadingTime(duration: number): number {
  return Math.max(0.18 * duration, 1e-9)
}

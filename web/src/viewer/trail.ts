/** The paths that bodies leave, in the frame that is shown: drawn up to now, fading behind. */
import { Vector3 } from 'three'
import type { Frame } from './contract'
import { newPose, type Pose, viewOf } from './frames'
import { BREAK } from './lines'
import { PHASE, type Scene, type Turn } from './scene'
import { Track } from './track'

const MOST_POINTS = 10_000
const MOST_BREAKS = 1000
const MOST_BETWEEN = 6 // points put between two samples that lie far apart

/**
 * The path of the contact on the support, and of the centre in flight, as x, y, z, t.
 *
 * In `corotating` the points are those of the support's material; otherwise those of the support frame, whichever of
 * the two inertial frames is shown.
 */
export function pathPoints(scene: Scene, frame: Frame, of: 'body' | 'guiding_centre' = 'body'): Float32Array {
  const track = new Track(scene)
  const { time, phase } = scene.columns
  const parts = Math.min(MOST_BETWEEN, Math.max(1, Math.floor(MOST_POINTS / Math.max(time.length, 1))))
  const out = new Float32Array(4 * (time.length * parts + MOST_BREAKS))
  let filled = 0
  const put = (x: number, y: number, z: number, t: number) => {
    if (filled + 4 > out.length) return
    out[filled++] = x
    out[filled++] = y
    out[filled++] = z
    out[filled++] = t
  }
  const place = new Vector3()
  const toMaterial = frame === 'corotating' ? materialFrame() : null
  let before: number | undefined
  for (let i = 0; i < time.length; i++) {
    const flying = of === 'body' && phase?.[i] === PHASE.flight
    // Between touching and flying it goes from the contact to the centre, which is no path.
    if (before !== undefined && Number(flying) !== before) put(0, 0, 0, BREAK)
    before = Number(flying)
    const steps = i + 1 < time.length ? parts : 1
    for (let k = 0; k < steps; k++) {
      const t = time[i]! + (k / steps) * ((time[i + 1] ?? time[i]!) - time[i]!)
      track.seek(t)
      if (of === 'guiding_centre') {
        if (!track.vector('guiding_centre', place)) continue
      } else if (flying) track.position(place)
      else track.contact(place)
      toMaterial?.(track, place)
      if (Number.isFinite(place.x + place.y + place.z)) put(place.x, place.y, place.z, t)
    }
  }
  return out.slice(0, filled)
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

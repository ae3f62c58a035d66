/** The state at an instant, between two samples, as the samples say it. */
import { countBefore } from '../../viewer/ascending'
import { PHASE, type Scene, type Triple, type Turn } from '../../viewer/scene'
import type { Instant } from '../api'

/** A body that leaves the support just now still touches, for single precision, m. */
const LEAST = 1e-6

/** Index of the last sample at or before a time. */
export function indexAt(times: Float64Array, time: number): number {
  return Math.max(countBefore(times, time, true) - 1, 0)
}

export function instantAt(scene: Scene, time: number): Instant {
  const { columns } = scene
  const index = indexAt(columns.time, time)
  const next = Math.min(index + 1, columns.time.length - 1)
  const from = columns.time[index] ?? 0
  const gap = (columns.time[next] ?? 0) - from
  const part = gap > 0 ? Math.min(1, Math.max(0, (time - from) / gap)) : 0

  const mixed = (column: Float32Array | Float64Array | undefined, width: number): number[] =>
    Array.from({ length: width }, (_, axis) => {
      const a = column?.[index * width + axis] ?? 0
      const b = column?.[next * width + axis] ?? 0
      return a + (b - a) * part
    })

  const turn = (column: Float32Array | undefined): Turn => {
    const q = column ? mixed(column, 4) : [1, 0, 0, 0]
    const size = Math.hypot(...q) || 1
    return q.map((one) => one / size) as Turn
  }

  const position = mixed(columns.position, 3) as Triple
  const contact = mixed(columns.contact ?? columns.position, 3) as Triple
  const flies = columns.phase?.[part < 1 ? index : next] === PHASE.flight
  const above = Math.hypot(...position.map((one, axis) => one - contact[axis]!)) - scene.header.body.radius
  return {
    time,
    position,
    contact,
    ...(flies && above > LEAST && { height: above }),
    velocity: mixed(columns.velocity, 3) as Triple,
    angular_velocity: mixed(columns.angular_velocity, 3) as Triple,
    orientation: turn(columns.orientation),
    support: mixed(columns.support_coordinates, (columns.support_coordinates?.length ?? 0) / columns.time.length),
  }
}

/** The state at the sample next to a time: to go on from it loses nothing, as it would from between two samples. */
export function sampleAt(scene: Scene, time: number): Instant {
  const times = scene.columns.time
  const before = indexAt(times, time)
  const after = Math.min(before + 1, times.length - 1)
  const nearer = Math.abs(times[after]! - time) < Math.abs(time - times[before]!) ? after : before
  return instantAt(scene, times[nearer]!)
}

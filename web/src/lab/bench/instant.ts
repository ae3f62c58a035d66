/** The state at an instant, between two samples, as the samples say it. */
import type { Scene, Triple, Turn } from '../../viewer/scene'

export interface Instant {
  time: number
  position: Triple
  contact: Triple
  velocity: Triple
  angularVelocity: Triple
  orientation: Turn
}

/** Index of the last sample at or before a time. */
export function indexAt(times: Float64Array, time: number): number {
  let low = 0
  let high = times.length - 1
  while (low < high) {
    const middle = (low + high + 1) >> 1
    if ((times[middle] ?? 0) <= time) low = middle
    else high = middle - 1
  }
  return low
}

export function instantAt(scene: Scene, time: number): Instant {
  const { columns } = scene
  const index = indexAt(columns.time, time)
  const next = Math.min(index + 1, columns.time.length - 1)
  const from = columns.time[index] ?? 0
  const gap = (columns.time[next] ?? 0) - from
  const part = gap > 0 ? Math.min(1, Math.max(0, (time - from) / gap)) : 0

  const mixed = (column: Float32Array | undefined, width: number): number[] =>
    Array.from({ length: width }, (_, axis) => {
      const a = column?.[index * width + axis] ?? 0
      const b = column?.[next * width + axis] ?? 0
      return a + (b - a) * part
    })

  const q = columns.orientation ? mixed(columns.orientation, 4) : [1, 0, 0, 0]
  const size = Math.hypot(...q) || 1
  return {
    time,
    position: mixed(columns.position, 3) as Triple,
    contact: mixed(columns.contact ?? columns.position, 3) as Triple,
    velocity: mixed(columns.velocity, 3) as Triple,
    angularVelocity: mixed(columns.angular_velocity, 3) as Triple,
    orientation: q.map((one) => one / size) as Turn,
  }
}

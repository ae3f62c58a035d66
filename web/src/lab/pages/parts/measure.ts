/** Reading numbers off a scene's samples: what one would measure with ruler, protractor and stopwatch. No laws here. */
import { countBefore } from '../../../viewer/ascending'
import type { Columns, Finding, Scene } from '../../../viewer/scene'

export type Vector = readonly [number, number, number]
export type Quaternion = readonly [w: number, x: number, y: number, z: number]

/** A column of samples, or nothing of length where the scene has none. */
export function column(scene: Scene, name: keyof Columns): ArrayLike<number> {
  return scene.columns[name] ?? []
}

export function vectorAt(values: ArrayLike<number>, i: number): Vector {
  return [values[3 * i] ?? 0, values[3 * i + 1] ?? 0, values[3 * i + 2] ?? 0]
}

export function quaternionAt(values: ArrayLike<number>, i: number): Quaternion {
  return [values[4 * i] ?? 1, values[4 * i + 1] ?? 0, values[4 * i + 2] ?? 0, values[4 * i + 3] ?? 0]
}

/** A vector of the body frame, turned into the support frame. */
export function turned([w, x, y, z]: Quaternion, [a, b, c]: Vector): Vector {
  const t: Vector = [2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)]
  return [a + w * t[0] + y * t[2] - z * t[1], b + w * t[1] + z * t[0] - x * t[2], c + w * t[2] + x * t[1] - y * t[0]]
}

/** The sample last reached at a time: the samples are dense, so that the nearest will do for a readout. */
export function sampleAt(scene: Scene, time: number): number {
  const times = column(scene, 'time')
  const next = countBefore(times, time, true)
  const [low, high] = [Math.max(next - 1, 0), Math.max(Math.min(next, times.length - 1), 0)]
  return Math.abs((times[high] ?? 0) - time) < Math.abs((times[low] ?? 0) - time) ? high : low
}

/** Where the body's north pole points at a sample, in the support frame. */
export function poleAt(scene: Scene, i: number): Vector {
  return turned(quaternionAt(column(scene, 'orientation'), i), [0, 0, 1])
}

/**
 * By how much a cylinder's mark has turned since the first sample, at each sample, rad: read off the mark itself,
 * counted on from sample to sample, in the sense that rolls it along the first axis.
 */
export function markAngles(scene: Scene): Float64Array {
  const orientation = column(scene, 'orientation')
  const count = column(scene, 'time').length
  const angles = new Float64Array(count)
  let before = 0
  for (let i = 0; i < count; i += 1) {
    const [x, , z] = turned(quaternionAt(orientation, i), [1, 0, 0])
    const angle = Math.atan2(x, z)
    if (i > 0) angles[i] = (angles[i - 1] ?? 0) + wrapped(angle - before)
    before = angle
  }
  return angles
}

/** By how much the direction of motion turned per second, first sample to last, rad/s; null for a ball that rests. */
export function headingRate(scene: Scene): number | null {
  const velocity = column(scene, 'velocity')
  const times = column(scene, 'time')
  const count = times.length
  let [total, before] = [0, 0]
  for (let i = 0; i < count; i += 1) {
    const [x, y] = vectorAt(velocity, i)
    if (Math.hypot(x, y) < 1e-9) return null
    const heading = Math.atan2(y, x)
    if (i > 0) total += wrapped(heading - before)
    before = heading
  }
  const lasted = (times[count - 1] ?? 0) - (times[0] ?? 0)
  return lasted > 0 ? total / lasted : null
}

/** How fast the guiding centre goes along, first sample to last, m/s; 0 where the scene has none. */
export function driftSeen(scene: Scene): number {
  const centre = column(scene, 'guiding_centre')
  const times = column(scene, 'time')
  const last = times.length - 1
  if (last < 1 || centre.length === 0) return 0
  const [a, b] = [vectorAt(centre, 0), vectorAt(centre, last)]
  return Math.hypot(b[0] - a[0], b[1] - a[1]) / ((times[last] ?? 1) - (times[0] ?? 0))
}

/** Greatest distance between two paths at equal samples, m. */
export function apart(one: Scene, other: Scene): number {
  const [a, b] = [column(one, 'position'), column(other, 'position')]
  let most = 0
  for (let i = 0; i < Math.min(a.length, b.length) / 3; i += 1) {
    const [p, q] = [vectorAt(a, i), vectorAt(b, i)]
    most = Math.max(most, Math.hypot(p[0] - q[0], p[1] - q[1]))
  }
  return most
}

/** The path on the support plane as points. */
export function pathOf(scene: Scene, name: keyof Columns = 'contact'): [number, number][] {
  const values = column(scene, name)
  return Array.from({ length: Math.floor(values.length / 3) }, (_, i) => [values[3 * i] ?? 0, values[3 * i + 1] ?? 0])
}

/** The scene's finding of this symbol, in LaTeX as the server writes it. */
export function finding(scene: Scene, ...symbols: string[]): Finding | undefined {
  return scene.header.findings?.find(({ symbol }) => symbols.includes(symbol))
}

function wrapped(angle: number): number {
  return angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI))
}

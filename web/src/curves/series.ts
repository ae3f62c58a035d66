/** What may be drawn of a run: what the package sends as curves, and what the samples say by themselves. */
import type { Scene } from '../viewer/scene'

export interface Quantity {
  id: string
  label: string
  unit: string
  /** One value a sample; not a number where there is none (in flight, say). */
  values(): ArrayLike<number>
}

/** All that there is of a run, time last. */
export function quantitiesOf(scene: Scene): Quantity[] {
  const { header, columns } = scene
  const own = (header.curves ?? []).map(({ column, label, unit }): Quantity => {
    const values = (columns as unknown as Record<string, Float32Array>)[column] ?? new Float32Array()
    return { id: column.replace(/^curve_/, ''), label, unit, values: () => values }
  })
  const { position, velocity, angular_velocity: turning } = columns
  const each = (value: (index: number) => number) => Float64Array.from(columns.time, (_, index) => value(index))
  const size = (of: Float32Array) => () =>
    each((i) => Math.hypot(of[3 * i] ?? Number.NaN, of[3 * i + 1] ?? 0, of[3 * i + 2] ?? 0))
  const part = (axis: number) => () => each((i) => position[3 * i + axis] ?? Number.NaN)
  return [
    ...(velocity ? [{ id: 'speed', label: 'Speed', unit: 'm/s', values: size(velocity) }] : []),
    ...own,
    ...(turning ? [{ id: 'turning', label: 'Rate of turning |Ω|', unit: 'rad/s', values: size(turning) }] : []),
    {
      id: 'distance',
      label: 'Distance from the axis',
      unit: 'm',
      values: () => each((i) => Math.hypot(position[3 * i] ?? 0, position[3 * i + 1] ?? 0)),
    },
    { id: 'x', label: 'Position x', unit: 'm', values: part(0) },
    { id: 'y', label: 'Position y', unit: 'm', values: part(1) },
    { id: 'z', label: 'Height z over the axis’ foot', unit: 'm', values: part(2) },
    { id: 'time', label: 'Time', unit: 's', values: () => columns.time },
  ]
}

/** Numbers over time, read off the samples: sizes of vectors and their parts along the normal. No law of motion. */
import type { Scene } from '../../viewer/scene'

export interface Quantity {
  id: string
  label: string
  unit: string
  /** One value a sample; null where there is none (in flight, say). */
  values(scene: Scene): (number | null)[]
  has(scene: Scene): boolean
}

type Vectors = Float32Array | undefined

function size(column: Vectors, index: number): number {
  if (!column) return Number.NaN
  return Math.hypot(column[3 * index] ?? 0, column[3 * index + 1] ?? 0, column[3 * index + 2] ?? 0)
}

function over(scene: Scene, value: (index: number) => number): (number | null)[] {
  return Array.from(scene.columns.time, (_, index) => {
    const found = value(index)
    return Number.isFinite(found) ? found : null
  })
}

/** The normal is known of a ball (from its contact to its centre) and of a plane. */
function normal(scene: Scene, index: number): [number, number, number] | null {
  const { columns, header } = scene
  if (header.support.flat) return columns.support_orientation ? turnedZ(columns.support_orientation, index) : [0, 0, 1]
  if (!header.body.ball || !columns.contact) return null
  const d = [0, 1, 2].map(
    (axis) => (columns.position[3 * index + axis] ?? 0) - (columns.contact![3 * index + axis] ?? 0),
  )
  const length = Math.hypot(...d)
  return length > 0 ? [d[0]! / length, d[1]! / length, d[2]! / length] : null
}

function turnedZ(turns: Float32Array, index: number): [number, number, number] {
  const [w = 1, x = 0, y = 0, z = 0] = turns.subarray(4 * index, 4 * index + 4)
  return [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]
}

function normalForce(scene: Scene, index: number): number {
  const force = scene.columns.contact_force
  const n = normal(scene, index)
  if (!force || !n || scene.columns.phase?.[index] === 2) return Number.NaN
  return n.reduce((sum, part, axis) => sum + part * (force[3 * index + axis] ?? 0), 0)
}

function frictionNeeded(scene: Scene, index: number): number {
  const force = scene.columns.contact_force
  const along = normalForce(scene, index)
  if (!force || !(along > 0)) return Number.NaN
  return Math.sqrt(Math.max(0, size(force, index) ** 2 - along ** 2)) / along
}

const forces = (scene: Scene) => scene.columns.contact_force !== undefined && normal(scene, 0) !== null
const axis = (name: 'x' | 'y' | 'z', label: string): Quantity => ({
  id: name,
  label,
  unit: 'm',
  has: () => true,
  values: (scene) => over(scene, (index) => scene.columns.position[3 * index + 'xyz'.indexOf(name)] ?? Number.NaN),
})

export const QUANTITIES: Quantity[] = [
  {
    id: 'speed',
    label: 'Speed',
    unit: 'm/s',
    has: (scene) => scene.columns.velocity !== undefined,
    values: (scene) => over(scene, (index) => size(scene.columns.velocity, index)),
  },
  {
    id: 'friction',
    label: 'Friction needed, |f|/N',
    unit: '',
    has: forces,
    values: (scene) => over(scene, (index) => frictionNeeded(scene, index)),
  },
  {
    id: 'normal',
    label: 'Normal force N',
    unit: 'N',
    has: forces,
    values: (scene) => over(scene, (index) => normalForce(scene, index)),
  },
  {
    id: 'turning',
    label: 'Rate of turning |Ω|',
    unit: 'rad/s',
    has: (scene) => scene.columns.angular_velocity !== undefined,
    values: (scene) => over(scene, (index) => size(scene.columns.angular_velocity, index)),
  },
  {
    id: 'distance',
    label: 'Distance from the axis',
    unit: 'm',
    has: () => true,
    values: (scene) =>
      over(scene, (index) =>
        Math.hypot(scene.columns.position[3 * index] ?? 0, scene.columns.position[3 * index + 1] ?? 0),
      ),
  },
  axis('x', 'Position x'),
  axis('y', 'Position y'),
  axis('z', 'Height z over the axis’ foot'),
]

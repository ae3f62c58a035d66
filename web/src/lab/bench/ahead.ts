/** The whole path while the film stands still, so that a change shows at once what it changes. */
import type { Scene, Triple } from '../../viewer/scene'
import type { Frame } from '../../viewer/viewer'

const MOST = 4000

type Turn = readonly [number, number, number, number]

/** A vector of the support frame in the support's own material: turned back by its orientation. */
function turnedBack([w, x, y, z]: Turn, [a, b, c]: Triple): Triple {
  // v' = v + 2u×(u×v + wv), for the conjugate quaternion u = −(x, y, z).
  const [p, q, r] = [-x, -y, -z]
  const [d, e, f] = [q * c - r * b + w * a, r * a - p * c + w * b, p * b - q * a + w * c]
  return [a + 2 * (q * f - r * e), b + 2 * (r * d - p * f), c + 2 * (p * e - q * d)]
}

/** The contact's path thinned out where there are very many points, in the inertial frame or in that of the support's material. */
export function pathOf({ columns }: Scene, frame: Frame): Triple[] {
  const path = columns.contact ?? columns.position
  const { support_orientation: turns, support_position: places } = columns
  const count = columns.time.length
  const step = Math.max(1, Math.ceil(count / MOST))
  const points: Triple[] = []
  const at = (column: Float32Array | undefined, index: number): Triple => [
    column?.[3 * index] ?? 0,
    column?.[3 * index + 1] ?? 0,
    column?.[3 * index + 2] ?? 0,
  ]
  const add = (index: number) => {
    const [x, y, z] = at(path, index)
    if (!Number.isFinite(x + y + z)) return
    if (frame !== 'corotating' || !turns) return void points.push([x, y, z])
    const [a, b, c] = at(places, index)
    const turn = turns.subarray(4 * index, 4 * index + 4) as unknown as Turn
    points.push(turnedBack(turn, [x - a, y - b, z - c]))
  }
  for (let index = 0; index < count; index += step) add(index)
  if ((count - 1) % step !== 0) add(count - 1)
  return points
}

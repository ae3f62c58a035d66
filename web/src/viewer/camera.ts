/** Where a camera must stand so that given points fill its picture. */
import { Vector3 } from 'three'

export interface Fit {
  eye: Vector3
  target: Vector3
}

const MARGIN = 1.1
const ROUNDS = 3

/**
 * Fit points into a picture seen from `direction` (from the target to the eye). The target is moved sideways until as
 * much is free on the left as on the right, and above as below.
 */
export function fitted(
  points: readonly Vector3[],
  direction: Vector3,
  angle: number,
  aspect: number,
  up: Vector3 = new Vector3(0, 0, 1),
): Fit {
  const back = direction.clone().normalize()
  const right = new Vector3().crossVectors(up, back)
  if (right.lengthSq() < 1e-8) right.set(1, 0, 0)
  right.normalize()
  const above = new Vector3().crossVectors(back, right)
  const tall = Math.tan((angle * Math.PI) / 360) / MARGIN
  const wide = tall * aspect
  const target = middle(points)
  let distance = 0.1
  for (let round = 0; round < ROUNDS; round++) {
    const places = points.map((point) => {
      const off = point.clone().sub(target)
      return { x: off.dot(right), y: off.dot(above), z: off.dot(back) }
    })
    distance = Math.max(0.1, ...places.map(({ x, y, z }) => z + Math.max(Math.abs(x) / wide, Math.abs(y) / tall)))
    if (round === ROUNDS - 1) break
    const across = places.map(({ x, z }) => x / (distance - z))
    const along = places.map(({ y, z }) => y / (distance - z))
    target.addScaledVector(right, 0.5 * (Math.max(...across) + Math.min(...across)) * distance)
    target.addScaledVector(above, 0.5 * (Math.max(...along) + Math.min(...along)) * distance)
  }
  return { target, eye: target.clone().addScaledVector(back, distance) }
}

function middle(points: readonly Vector3[]): Vector3 {
  const low = new Vector3(Infinity, Infinity, Infinity)
  const high = new Vector3(-Infinity, -Infinity, -Infinity)
  for (const point of points) {
    low.min(point)
    high.max(point)
  }
  return points.length ? low.add(high).multiplyScalar(0.5) : new Vector3()
}

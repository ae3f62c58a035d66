/** The support's normal where a body touches it, in the support frame. */
import { Quaternion, Vector3 } from 'three'
import type { BodyModel } from './bodies'
import type { Scene } from './scene'

const centre = new Vector3()
const turn = new Quaternion()

export function contactNormal(body: BodyModel, ground: Scene, contact: Vector3, out: Vector3): Vector3 {
  const { track, radius } = body
  const { support } = ground.header
  track.supportOrientation(turn)
  if (support.flat) return out.set(0, 0, 1).applyQuaternion(turn)
  track.position(centre)
  out.copy(centre).sub(contact)
  // A sphere's centre stands on the normal.
  if (Math.abs(out.length() / radius - 1) < 0.02) return out.normalize()
  const { support_vertices: vertices, support_normals: normals } = ground.columns
  if (!vertices || !normals) return out.normalize()
  track.supportPosition(centre)
  const place = contact.clone().sub(centre).applyQuaternion(turn.clone().conjugate())
  return out.fromArray(normals, nearest(vertices, place)).applyQuaternion(turn)
}

function nearest(vertices: Float32Array, { x, y, z }: Vector3): number {
  let [found, least] = [0, Infinity]
  for (let i = 0; i + 2 < vertices.length; i += 3) {
    const [a, b, c] = [vertices[i]! - x, vertices[i + 1]! - y, vertices[i + 2]! - z]
    const off = a * a + b * b + c * c
    if (off < least) [found, least] = [i, off]
  }
  return found
}

/** A scene's state at any time, between its samples too: positions by Hermite's cubic, orientations by slerp. */
import { Quaternion, Vector3 } from 'three'
import { countBefore } from './ascending'
import { PHASE, type Scene } from './scene'

export class Track {
  readonly count: number
  private index = 0
  private share = 0
  private readonly from = new Vector3()
  private readonly to = new Vector3()
  private readonly centre = new Vector3()
  private readonly start = new Quaternion()
  private readonly finish = new Quaternion()

  constructor(readonly scene: Scene) {
    this.count = scene.columns.time.length
  }

  get begin(): number {
    return this.scene.columns.time[0]!
  }

  get end(): number {
    return this.scene.columns.time[this.count - 1]!
  }

  /** Go to a time; before the first and after the last sample the body stays where it is. */
  seek(time: number): this {
    const { time: times } = this.scene.columns
    this.index = sampleBefore(times, time, this.index)
    const step = times[this.index + 1] === undefined ? 0 : times[this.index + 1]! - times[this.index]!
    this.share = step > 0 ? Math.min(Math.max((time - times[this.index]!) / step, 0), 1) : 0
    return this
  }

  /** The sample last reached. */
  get sample(): number {
    return this.share < 1 ? this.index : Math.min(this.index + 1, this.count - 1)
  }

  get phase(): number {
    return this.scene.columns.phase?.[this.sample] ?? PHASE.rolling
  }

  position(out: Vector3): Vector3 {
    const { time, position, velocity } = this.scene.columns
    if (!velocity || this.index + 1 >= this.count) return this.linear(position, out)
    return hermite(position, velocity, time, this.index, this.share, out)
  }

  /** Where it touches: the centre, and the way from there to the contact between the samples. */
  contact(out: Vector3): Vector3 {
    const { position, contact } = this.scene.columns
    this.position(out)
    if (!contact) return out
    const way = this.linear(contact, this.to).sub(this.linear(position, this.centre))
    return Number.isFinite(way.x + way.y + way.z) ? out.add(way) : out
  }

  vector(name: 'velocity' | 'angular_velocity' | 'contact_force' | 'guiding_centre', out: Vector3): Vector3 | null {
    const column = this.scene.columns[name]
    if (!column) return null
    this.linear(column, out)
    return Number.isFinite(out.x + out.y + out.z) ? out : null
  }

  orientation(out: Quaternion): Quaternion {
    return this.turn(this.scene.columns.orientation, out)
  }

  supportOrientation(out: Quaternion): Quaternion {
    return this.turn(this.scene.columns.support_orientation, out)
  }

  supportPosition(out: Vector3): Vector3 {
    const column = this.scene.columns.support_position
    return column ? this.linear(column, out) : out.set(0, 0, 0)
  }

  private linear(column: Float32Array, out: Vector3): Vector3 {
    out.fromArray(column, 3 * this.index)
    if (this.share === 0 || this.index + 1 >= this.count) return out
    return out.lerp(this.from.fromArray(column, 3 * this.index + 3), this.share)
  }

  private turn(column: Float32Array | undefined, out: Quaternion): Quaternion {
    if (!column) return out.identity()
    quaternionAt(column, this.index, this.start)
    if (this.share === 0 || this.index + 1 >= this.count) return out.copy(this.start)
    return slerp(this.start, quaternionAt(column, this.index + 1, this.finish), this.share, out)
  }
}

/** The last sample not after a time, near `hint` first: play goes on, it seldom leaps. */
export function sampleBefore(times: ArrayLike<number>, time: number, hint = 0): number {
  const last = Math.max(times.length - 2, 0)
  let low = Math.min(Math.max(hint, 0), last)
  for (let tries = 0; tries < 4; tries++) {
    if (times[low]! > time && low > 0) low--
    else if (low < last && times[low + 1]! <= time) low++
    else return low
  }
  return Math.min(Math.max(countBefore(times, time, true) - 1, 0), last)
}

/** w, x, y, z as columns hold them. */
export function quaternionAt(column: ArrayLike<number>, index: number, out: Quaternion): Quaternion {
  const at = 4 * index
  return out.set(column[at + 1]!, column[at + 2]!, column[at + 3]!, column[at]!)
}

/** From one orientation to another at a steady rate, the shorter way. */
export function slerp(from: Quaternion, to: Quaternion, share: number, out: Quaternion): Quaternion {
  const cosine = from.dot(to)
  const angle = Math.acos(Math.min(Math.abs(cosine), 1))
  const near = angle < 1e-3 // where sines would be divided by nearly nothing
  const a = near ? 1 - share : Math.sin((1 - share) * angle) / Math.sin(angle)
  const b = (near ? share : Math.sin(share * angle) / Math.sin(angle)) * (cosine < 0 ? -1 : 1)
  return out.set(a * from.x + b * to.x, a * from.y + b * to.y, a * from.z + b * to.z, a * from.w + b * to.w).normalize()
}

/**
 * The cubic that has the samples' positions and velocities; the straight line where these do not belong together, as
 * at an impact, behind which the velocity is another.
 */
export function hermite(
  place: ArrayLike<number>,
  velocity: ArrayLike<number>,
  times: ArrayLike<number>,
  index: number,
  share: number,
  out: Vector3,
): Vector3 {
  // Plain numbers: this runs for each of ten thousand points of a path whenever a run is new.
  const i = 3 * index
  const h = times[index + 1]! - times[index]!
  const u = 1 - share
  let [a, b, c, d] = [u, share, 0, 0]
  if (agree(place, velocity, i, h)) {
    a = u * u * (1 + 2 * share)
    b = share * share * (3 - 2 * share)
    c = share * u * u * h
    d = -share * share * u * h
  }
  return out.set(
    a * place[i]! + b * place[i + 3]! + c * velocity[i]! + d * velocity[i + 3]!,
    a * place[i + 1]! + b * place[i + 4]! + c * velocity[i + 1]! + d * velocity[i + 4]!,
    a * place[i + 2]! + b * place[i + 5]! + c * velocity[i + 2]! + d * velocity[i + 5]!,
  )
}

function agree(place: ArrayLike<number>, velocity: ArrayLike<number>, i: number, h: number): boolean {
  let off = 0
  let size = 0
  for (let axis = i; axis < i + 3; axis++) {
    const v = velocity[axis]! * h
    const w = velocity[axis + 3]! * h
    off = Math.max(off, Math.abs(place[axis + 3]! - place[axis]! - 0.5 * (v + w)))
    size = Math.max(size, Math.abs(v), Math.abs(w))
  }
  return off <= 0.15 * size
}

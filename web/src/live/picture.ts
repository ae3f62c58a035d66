/** A course as a scene: its rows as columns, and the meshes as they are for the values of the sliders. */
import { type ColumnArray, type Columns, PHASE, type Scene, type SceneHeader, type Triple } from '../viewer/scene'
import type { Course } from './course'
import type { LiveCurve, LiveHeader, Variant } from './header'

type Mutable = { -readonly [Name in keyof Columns]: Columns[Name] }

const SLIP = 'curve_slip'
const VECTORS = ['position', 'contact', 'velocity', 'angular_velocity', 'contact_force'] as const

export class Pictures {
  private readonly decoded = new Map<string, Float32Array>()

  constructor(
    private readonly base: Scene,
    private readonly live: LiveHeader,
  ) {}

  /** The scene of a course for these values of the sliders. */
  scene(course: Course, values: readonly number[]): Scene {
    const columns: Mutable = { ...this.base.columns, time: Float64Array.from(course.time) }
    for (const name of VECTORS) columns[name] = this.taken(course, `${name}_x`, 3)
    columns.orientation = continuous(this.taken(course, 'orientation_w', 4))
    columns.phase = Uint8Array.from(course.phase)
    delete columns.guiding_centre
    delete columns.support_coordinates
    if (columns.support_position) {
      columns.support_position = this.taken(course, 'support_position_x', 3)
      columns.support_orientation = continuous(turns(this.taken(course, 'support_rotation_xx', 9)))
    }
    for (const variant of this.live.variants) this.bend(columns, variant, values[variant.slider]!)
    const drawn = this.drawn(course)
    const header = { ...this.header(course, columns), curves: drawn.map(([curve]) => curve) }
    return { header, columns: { ...columns, ...Object.fromEntries(drawn.map(([{ column }, row]) => [column, row])) } }
  }

  private taken(course: Course, first: string, width: number): Float32Array {
    const begin = this.live.film.indexOf(first)
    const found = new Float32Array(course.rows.length * width)
    course.rows.forEach((row, i) => {
      for (let j = 0; j < width; j++) found[width * i + j] = row[begin + j]!
    })
    return found
  }

  /** What may be drawn over the time; a slip that never comes is none. */
  private drawn({ rows, phase }: Course): [LiveCurve, Float32Array][] {
    const found = this.live.curves.map((curve): [LiveCurve, Float32Array] => {
      const none = (i: number) => curve.touching && phase[i] === PHASE.flight
      return [curve, Float32Array.from(rows, (row, i) => (none(i) ? Number.NaN : row[curve.index]!))]
    })
    return found.filter(([{ column }, values]) => column !== SLIP || values.some((value) => value !== 0))
  }

  private header(course: Course, columns: Columns): SceneHeader {
    const { header } = this.base
    const number = (name: string) => course.parameters[this.live.parameters.indexOf(name)]
    const tilt = number('support.tilt') ?? header.tilt
    const gravity: Triple = [0, 0, -(number('gravity') ?? -header.gravity[2])]
    const radius = columns.body_vertices === this.base.columns.body_vertices ? header.body.radius : reach(columns)
    return {
      ...header,
      tilt,
      gravity,
      to_world: [Math.cos(tilt / 2), 0, Math.sin(tilt / 2), 0],
      duration: course.time[course.time.length - 1]! - course.time[0]!,
      method: 'page',
      events: course.events,
      guiding_centre: false,
      formula: null,
      body: { ...header.body, radius, mass: number('body.mass') ?? header.body.mass },
      support: {
        ...header.support,
        rim: number('support.rim') ?? header.support.rim,
        friction: number('support.friction') ?? header.support.friction,
      },
    }
  }

  /** Change the meshes as they are at a value of a slider. */
  private bend(columns: Mutable, { slider, nodes, steps }: Variant, value: number): void {
    const weights = nodes.map((a) => nodes.reduce((w, b) => (a === b ? w : (w * (value - b)) / (a - b)), 1))
    for (const [name, step] of Object.entries(steps)) {
      const mesh = columns[name as keyof Columns] as Float32Array
      const bent = mesh === this.base.columns[name as keyof Columns] ? mesh.slice() : mesh
      weights.forEach((weight, k) => {
        if (weight === 0) return
        const change = this.change(`live_${slider}_${k}_${name}`, step)
        for (let i = 0; i < bent.length; i++) bent[i] = bent[i]! + weight * change[i]!
      })
      Object.assign(columns, { [name]: bent })
    }
  }

  /** What is added to a mesh at a node: the package wrote whole numbers of a step, each less the one before. */
  private change(name: string, step: number): Float32Array {
    const known = this.decoded.get(name)
    if (known) return known
    const bytes = (this.base.columns as unknown as Record<string, ColumnArray>)[name] as Uint8Array
    const count = bytes.length / 2
    const found = new Float32Array(count)
    const last = [0, 0, 0]
    for (let i = 0; i < count; i++) {
      const less = bytes[i]! | (bytes[count + i]! << 8)
      const whole = ((last[i % 3]! + less) << 16) >> 16
      last[i % 3] = whole
      found[i] = whole * step
    }
    this.decoded.set(name, found)
    return found
  }
}

/** Half the size of a body about its centre. */
function reach({ body_vertices: vertices }: Columns): number {
  let most = 0
  for (let i = 0; vertices && i + 2 < vertices.length; i += 3)
    most = Math.max(most, Math.hypot(vertices[i]!, vertices[i + 1]!, vertices[i + 2]!))
  return most
}

/** Unit quaternions, each with the sign that is nearer to the one before. */
function continuous(turns: Float32Array): Float32Array {
  for (let i = 4; i + 3 < turns.length; i += 4) {
    let along = 0
    for (let j = 0; j < 4; j++) along += turns[i + j]! * turns[i + j - 4]!
    if (along < 0) for (let j = 0; j < 4; j++) turns[i + j] = -turns[i + j]!
  }
  return turns
}

/** The quaternions of rotations, nine numbers each, row by row. */
function turns(rotations: Float32Array): Float32Array {
  const found = new Float32Array((rotations.length / 9) * 4)
  for (let i = 0; i < found.length / 4; i++) found.set(quaternion(rotations.subarray(9 * i, 9 * i + 9)), 4 * i)
  return found
}

/** Of the four ways to it that with the largest divisor. */
export function quaternion(R: ArrayLike<number>): [number, number, number, number] {
  const [xx, xy, xz, yx, yy, yz, zx, zy, zz] = Array.from(R) as [
    number,
    number,
    number,
    number,
    number,
    number,
    number,
    number,
    number,
  ]
  const rows: [number, number, number, number][] = [
    [1 + xx + yy + zz, zy - yz, xz - zx, yx - xy],
    [zy - yz, 1 + xx - yy - zz, xy + yx, xz + zx],
    [xz - zx, xy + yx, 1 - xx + yy - zz, yz + zy],
    [yx - xy, xz + zx, yz + zy, 1 - xx - yy + zz],
  ]
  const best = rows.reduce((a, b, i) => (b[i]! > rows[a]![a]! ? i : a), 0)
  const row = rows[best]!
  const size = Math.hypot(...row)
  return [row[0] / size, row[1] / size, row[2] / size, row[3] / size]
}

/** A run as the package packs it: a header, and columns of numbers over its samples. */

import { t } from '../languages/translate'
import type { LiveHeader } from '../live/header'

export type Triple = [number, number, number]
export type Turn = [w: number, x: number, y: number, z: number]
export type ColumnArray = Float32Array | Float64Array | Uint32Array | Uint8Array

export interface SceneEvent {
  time: number
  kind: string
  text: string
}

export interface Finding {
  name: string
  symbol: string
  predicted: number | null
  measured: number | null
  unit: string
  difference: number | null
  note: string
}

/** What a run shows, in one sentence, and its number by theory or in another way. */
export interface Headline {
  /** With {} for the number; and its unit in SI, or °. */
  said: string
  unit: string
  text: string
  other: string | null
  predicted: boolean
  how: string
}

/** A column over the samples that may be drawn. */
export interface CurveHeader {
  column: string
  label: string
  unit: string
}

export interface Formula {
  name: string
  source: string
  latex: string
  numbers_latex: string
}

export interface BodyHeader {
  kind: string
  radius: number
  name: string
  mass: number
  label: string
  /** What it is in one word: "ball", "disc"; scenes kept from before do not say. */
  noun?: string
  /** A sphere about its centre of mass, which rolls any way. */
  ball: boolean
}

export interface SupportHeader {
  kind: string
  name: string
  /** The same normal everywhere: its own third axis. */
  flat: boolean
  /** What rolls on it is within it, so that one has to look into it. */
  deep: boolean
  moves: boolean
  size: number
  centre?: Triple
  marks?: 'polar' | 'square'
  rim: number | null
  friction: number | null
}

export interface ColumnHeader {
  dtype: 'float32' | 'float64' | 'uint32' | 'uint8'
  shape: number[]
  offset: number
  unit: string
}

/** A mesh by a name that it shares with those that differ in nothing but their size, m. */
export interface MeshHeader {
  name: string
  size: number
}

export interface SceneHeader {
  /** Of a page that computes the motion itself. */
  live?: LiveHeader
  format: number
  title: string
  method: string
  /** Relative, of each of the method's steps; 0 for a closed form, which has none. */
  tolerance: number
  duration: number
  seconds?: number | null
  scenario?: unknown
  scenario_toml?: string
  columns: Record<string, ColumnHeader>
  /** Of a scene that leaves out what is known already. */
  meshes?: { body?: MeshHeader; support?: MeshHeader }
  gravity: Triple
  tilt: number
  to_world: Turn
  body: BodyHeader
  support: SupportHeader
  events: SceneEvent[]
  findings?: Finding[]
  headline?: Headline | null
  curves?: CurveHeader[]
  formula?: Formula | null
  guiding_centre?: boolean
  card?: unknown
  /** Of the charge in crossed fields, in the support frame. */
  E?: Triple
  B?: Triple
  turned?: number
  enclosed_area?: number
}

/** Vectors are in the inertial support frame, three numbers a sample; orientations are w, x, y, z. */
export interface Columns {
  time: Float64Array
  position: Float32Array
  contact?: Float32Array
  velocity?: Float32Array
  angular_velocity?: Float32Array
  contact_force?: Float32Array
  orientation?: Float32Array
  phase?: Uint8Array
  support_position?: Float32Array
  support_orientation?: Float32Array
  /** The coordinates of the support's own motion, side by side: of a free axle its angle, rad, and rate, rad/s. */
  support_coordinates?: Float64Array
  guiding_centre?: Float32Array
  /** Speed of slip, m/s; not a number in flight. */
  curve_slip?: Float32Array
  body_vertices?: Float32Array
  body_normals?: Float32Array
  body_triangles?: Uint32Array
  body_pattern?: Float32Array
  /** Fewer triangles of the same vertices, for pictures of few pixels. */
  body_coarse?: Uint32Array
  support_vertices?: Float32Array
  support_normals?: Float32Array
  support_triangles?: Uint32Array
  support_marks?: Float32Array
}

export interface Scene {
  readonly header: SceneHeader
  readonly columns: Columns
}

/** Codes of the column `phase`. */
export const PHASE = { rolling: 0, slipping: 1, flight: 2, resting: 3 } as const

const MAGIC = 'TRUNDLE1'
const FORMAT = 3
const START = 16
const WRAP = 2 ** 32
const TYPES = { float32: Float32Array, float64: Float64Array, uint32: Uint32Array, uint8: Uint8Array }

/** Read a packed scene. */
export function unpack(bytes: ArrayBuffer | ArrayBufferView): Scene {
  const whole = ArrayBuffer.isView(bytes)
    ? new Uint8Array(bytes.buffer, bytes.byteOffset, bytes.byteLength)
    : new Uint8Array(bytes)
  const magic = whole.length < START ? '' : String.fromCharCode(...whole.subarray(0, MAGIC.length))
  if (magic !== MAGIC)
    throw new Error(`A packed scene begins with ${MAGIC}; got ${whole.length} bytes of something else.`)
  const length = new DataView(whole.buffer, whole.byteOffset).getUint32(MAGIC.length, true)
  const base = START + length
  if (base > whole.length) throw new Error(`The scene ends within its header: ${whole.length} of ${base} bytes came.`)
  const header = JSON.parse(new TextDecoder().decode(whole.subarray(START, base))) as SceneHeader
  if (header.format !== FORMAT) throw new Error(`This viewer reads scenes of format ${FORMAT}; got ${header.format}.`)
  const columns: Record<string, ColumnArray> = {}
  for (const [name, column] of Object.entries(header.columns)) columns[name] = read(whole, base, name, column)
  if (!columns.time?.length || !columns.position) throw new Error('A scene needs the columns time and position.')
  return { header, columns: columns as unknown as Columns }
}

/** A column: all first bytes of its rows, then all second bytes, and so on; these are second differences of integers. */
function read(whole: Uint8Array, base: number, name: string, { dtype, shape, offset }: ColumnHeader): ColumnArray {
  const column = new TYPES[dtype](shape.reduce((product, side) => product * side, 1))
  const begin = base + offset
  const end = begin + column.byteLength
  if (end > whole.length) throw new Error(`The column ${name} ends at byte ${end} of ${whole.length}.`)
  const rows = shape[0] ?? 1
  const size = column.BYTES_PER_ELEMENT
  const side = column.length / rows
  const add = size === 1 ? addBytes : size === 4 ? addWords : addLongs
  for (let part = 0; part < side; part++) add(whole, begin + part * size * rows, rows, column.buffer, part, side)
  return column
}

/** Sums up twice what belongs to one place of each row, `step` numbers apart; sums wrap. */
type Add = (whole: Uint8Array, from: number, rows: number, to: ArrayBufferLike, first: number, step: number) => void

const addBytes: Add = (whole, from, rows, to, first, step) => {
  const bytes = new Uint8Array(to)
  for (let i = first, at = from, grown = 0, sum = 0; at < from + rows; at++, i += step) {
    grown += whole[at]!
    sum = (sum + grown) & 255
    bytes[i] = sum
  }
}

const addWords: Add = (whole, from, rows, to, first, step) => {
  const words = new Uint32Array(to)
  for (let i = first, at = from, grown = 0, sum = 0; at < from + rows; at++, i += step) {
    grown = (grown + wordAt(whole, at, rows)) >>> 0
    sum = (sum + grown) >>> 0
    words[i] = sum
  }
}

/** Word by word, since to add big integers takes ten times as long. */
const addLongs: Add = (whole, from, rows, to, first, step) => {
  const words = new Uint32Array(to)
  let [grown, grownHigh, sum, sumHigh] = [0, 0, 0, 0]
  for (let i = 2 * first, at = from; at < from + rows; at++, i += 2 * step) {
    grown += wordAt(whole, at, rows)
    grownHigh = (grownHigh + wordAt(whole, at + 4 * rows, rows) + Number(grown >= WRAP)) >>> 0
    grown >>>= 0
    sum += grown
    sumHigh = (sumHigh + grownHigh + Number(sum >= WRAP)) >>> 0
    sum >>>= 0
    words[i] = sum
    words[i + 1] = sumHigh
  }
}

function wordAt(whole: Uint8Array, at: number, rows: number): number {
  const low = whole[at]! | (whole[at + rows]! << 8) | (whole[at + 2 * rows]! << 16)
  return (low | (whole[at + 3 * rows]! << 24)) >>> 0
}

/** Whether two columns hold the same numbers; two that are absent may stand for different things. */
export function sameNumbers(one: ColumnArray | undefined, other: ColumnArray | undefined): boolean {
  if (!one || !other || one.length !== other.length) return false
  for (let i = 0; i < one.length; i++) if (one[i] !== other[i]) return false
  return true
}

/** What a picture of scenes shows, in words. */
export function saidOf(scenes: readonly Scene[]): string {
  const one = ({ header: { body, support } }: Scene) => t(`${body.name} on ${support.name.toLowerCase()}`)
  const what = scenes.map(one).join('; ')
  return what ? t('3-D picture: {title}', { title: what }) : t('3-D picture, empty')
}

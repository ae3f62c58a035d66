/** What a scenario may be made of, as the package says it (`/api/parts`): no page keeps a list of its own. */
import type { Units } from './quantity'
import type { Json, Table } from './scenario'

interface Told {
  label: string
  said: string
  default?: Json
  /** May be left out, and then there is no such thing. */
  optional?: boolean
}

/** One number; SI, but for its example. */
export interface NumberField extends Told {
  type: 'number'
  dimension: string
  /** To begin with. */
  unit: string
  min: number
  max: number
  /** The slider goes by decades. */
  decades: boolean
  example: Json
}

export interface VectorField extends Omit<NumberField, 'type'> {
  type: 'vector'
  names: string[]
}

export interface FormulaField extends Told {
  type: 'formula'
}

export interface ChoiceField extends Told {
  type: 'choice'
  words: string[]
}

export type PartField = NumberField | VectorField | FormulaField | ChoiceField
export type Fields = Record<string, PartField>

export interface Kind {
  label: string
  said: string
  fields: Fields
  /** The table with which it is chosen; null where that takes more than numbers. */
  first: (Table & { kind: string }) | null
}

export interface BodyKind extends Kind {
  /** A sphere about its centre of mass, which rolls any way. */
  ball: boolean
  /** Of a kind of ball that has only one. */
  inertia_ratio: number | null
  /** What of a start goes with it. */
  start: Table
}

export interface SurfaceKind extends Kind {
  coordinates: [Coordinate, Coordinate]
  start: Table
}

export interface Coordinate {
  label: string
  dimension: string
  unit: string
}

export interface MotionKind extends Kind {
  /** The key of the number that says how fast the support turns on the whole. */
  rate: string | null
}

export interface LoadKind extends Kind {
  /** Has a slider also where there is none. */
  usual: boolean
}

export interface Parts {
  body: Record<string, BodyKind>
  support: Record<string, SurfaceKind>
  motion: Record<string, MotionKind>
  loads: Record<string, LoadKind>
  common: Record<'scenario' | 'support' | 'start' | 'run' | 'ball', Fields>
  path: Record<string, Fields>
  /** The kind of motion that a support has which says none. */
  at_rest: string
  /** Of each dimension. */
  units: Record<string, Units>
}

/** What a live page's scene says besides: which sliders there are, and how its pictures change along them. */

import type { CurveHeader } from '../viewer/scene'

export interface SliderHeader {
  name: string
  value: number
  low: number
  high: number
  label: string
  group: string
  unit: string
  /** Of the unit, in SI. */
  factor: number
}

export interface Variant {
  slider: number
  nodes: number[]
  /** Of each column that changes, the step of which its changes are whole numbers. */
  steps: Record<string, number>
}

/** Of the curves: where in a row of a course it stands, and whether there is none in flight. */
export interface LiveCurve extends CurveHeader {
  index: number
  touching: boolean
}

export interface LiveHeader {
  sliders: SliderHeader[]
  variants: Variant[]
  curves: LiveCurve[]
  /** What a row of a course holds, and what its parameters are called. */
  film: string[]
  parameters: string[]
}

/** The law of one motion as the package prints it into a page: `trundle.live.law`. */

export type Numbers = readonly number[]

export interface Reset {
  /** The code of the phase that follows; null where only one may. */
  choice: ((t: number, y: Numbers, p: Numbers, u: Numbers) => number[]) | null
  states: Record<string, (t: number, y: Numbers, p: Numbers, u: Numbers) => number[]>
}

export interface Phase {
  /** What it is: by a closed form it has the name of the phase of contact, too. */
  name: string
  /** As in the column `phase` of a run. */
  code: number
  rates: (t: number, y: Numbers, p: Numbers, u: Numbers) => number[]
  events: (t: number, y: Numbers, p: Numbers, u: Numbers, e: Numbers) => number[]
  film: (t: number, y: Numbers, p: Numbers, u: Numbers) => number[]
  /** What `events` takes as e, of the state in which the phase begins. */
  eventParameters?: (t: number, y: Numbers, p: Numbers, u: Numbers) => number[]
  names: string[]
  /** Which numbers of the state belong together: first, behind the last, and what they are. */
  groups: [number, number, string][]
  resets: Record<string, Reset>
}

/** Coefficients of an explicit Runge-Kutta method of order 8, with errors of orders 5 and 3 and a dense output. */
export interface Method {
  c: number[]
  a: number[][]
  e3: number[]
  e5: number[]
  d: number[][]
}

/** What of a motion its headline is told from. */
export interface Shows {
  /** Of the headline that the motion in the file has, with {} for its number; empty where it has none. */
  said: string
  ball: boolean
  /** Whether what rolls is within the support. */
  deep: boolean
  /** What the numbers of a row of the film are called, and those of the system. */
  row: string[]
  parameters: string[]
  /** Of a unit of SI: size, symbol and least count of those that numbers are told in, the largest first. */
  units: Record<string, [number, string, number][]>
}

export interface Law {
  shows: Shows
  begin: number
  duration: number
  phase: string
  size: number
  defaults: number[]
  arm: number
  moment: number
  tolerance: number
  codes: Record<string, number>
  /** The code where no phase follows. */
  nothing: number
  /** Where in a row of the film the angular velocity begins. */
  turning: number
  said: Record<string, Record<string, string>>
  ends: Record<string, string>
  method: Method
  placed: (w: Numbers) => number[]
  /** What theory says of what is seen, of the start; null where only numbers tell it. */
  promised: ((t: number, y: Numbers, p: Numbers, u: Numbers) => number[]) | null
  phases: Record<string, Phase>
}

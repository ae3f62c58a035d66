/** What a ball is rolled along, as the pieces that the server takes: quarter turns, loops, a hand's way. */
import type { Json } from '../../scenario'

export type Turn = 'E' | 'N' | 'W' | 'S'
export type Piece = { [key: string]: Json }
export type Place = readonly [x: number, y: number]

const QUARTER = Math.PI / 2
export const HEADING: Readonly<Record<Turn, number>> = { E: 0, N: QUARTER, W: Math.PI, S: 3 * QUARTER }
const BACK: Readonly<Record<Turn, Turn>> = { E: 'W', W: 'E', N: 'S', S: 'N' }
export const TURN_NAMES: Readonly<Record<Turn, string>> = { E: 'east', N: 'north', W: 'west', S: 'south' }

/** Each turn a straight piece by which the ball rolls a quarter. */
export function piecesOf(turns: readonly Turn[]): Piece[] {
  return turns.map((turn) => ({ kind: 'straight', heading: HEADING[turn], turn: QUARTER }))
}

/** How far it is from home, in quarter turns: whole numbers, so that home is home exactly. */
export function netOf(turns: readonly Turn[]): { east: number; north: number } {
  const count = (turn: Turn) => turns.filter((one) => one === turn).length
  return { east: count('E') - count('W'), north: count('N') - count('S') }
}

export function isHome(turns: readonly Turn[]): boolean {
  const { east, north } = netOf(turns)
  return east === 0 && north === 0
}

/** The same way back: the last turn first, each the other way. */
export function backAlong(turns: readonly Turn[]): Turn[] {
  return [...turns].reverse().map((turn) => BACK[turn])
}

/**
 * The loop that leads from the end of one way to the end of another: back along the first, out along the second.
 * What it turns the ball by is how the ends of the two ways differ.
 */
export function between(first: readonly Turn[], second: readonly Turn[]): Turn[] {
  return [...backAlong(first), ...second]
}

/** "east, then north". */
export function inWords(turns: readonly Turn[]): string {
  return turns.map((turn) => TURN_NAMES[turn]).join(', then ')
}

export type Shape = 'circle' | 'square'

/** Once round, to the left from a heading along the first axis: a circle of this radius, or a square of this side. */
export function loop(shape: Shape, size: number, left = true): Piece[] {
  if (shape === 'circle') return [{ kind: 'arc', radius: size, angle: (left ? 2 : -2) * Math.PI, heading: 0 }]
  const round: Turn[] = left ? ['E', 'N', 'W', 'S'] : ['E', 'S', 'W', 'N']
  return round.map((turn) => ({ kind: 'straight', heading: HEADING[turn], length: size }))
}

/** A hand's way as straight pieces: a point is kept only where it lies this far from the one before. */
export function thinned(points: readonly Place[], least: number): Place[] {
  const kept: Place[] = []
  for (const point of points) {
    const last = kept[kept.length - 1]
    if (!last || Math.hypot(point[0] - last[0], point[1] - last[1]) >= least) kept.push(point)
  }
  return kept
}

/** Straight pieces from one place to the next; the first is where the ball stands. */
export function along(points: readonly Place[]): Piece[] {
  return points.slice(1).map(([x, y]) => ({ kind: 'straight', to: [x, y] }))
}

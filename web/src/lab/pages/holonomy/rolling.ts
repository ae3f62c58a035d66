/** Asking the server to roll a ball, and reading its answer. Every pose comes from there. */
import type { Scene } from '../../../viewer/scene'
import type { App } from '../../app'
import type { Json } from '../../scenario'
import { poleAt, type Quaternion, sampleAt, type Vector } from '../parts/measure'
import type { Piece, Place } from './turns'

export const RADIUS = 0.025

export interface Start {
  position: Place
  orientation: Quaternion
}

/** What the header of a rolled scene holds besides a scene's. */
export interface Rolled {
  /** 0 to π, from the first orientation to the last. */
  turned: number
  turned_axis: Vector
  turned_about_normal: number
  north_pole: Vector
  closed: boolean
  /** Positive anticlockwise; null where the path is open. */
  enclosed_area: number | null
  /** Whether it is so short beside the ball that the rule for small loops tells something. */
  small_loop: boolean
  small_loop_angle: number | null
  length: number
  stages: { time: number; position: Vector; orientation: [number, number, number, number]; north_pole: Vector }[]
}

export interface RollOptions {
  start?: Start
  samples?: number
  signal?: AbortSignal
}

export async function roll(app: App, pieces: Piece[], { start, samples, signal }: RollOptions = {}): Promise<Scene> {
  const curve: Record<string, Json> = { path: pieces }
  if (start) curve.start = { position: [...start.position], orientation: [...start.orientation] }
  const request = { radius: RADIUS, curve }
  const options = { lane: null, ...(samples ? { samples } : {}), ...(signal ? { signal } : {}) }
  return (await app.api.roll(request, options)).scene
}

export function rolledOf(scene: Scene): Rolled {
  return scene.header as unknown as Rolled
}

/** Where the pole points while the scene is shown at a time. */
export function poleWhile(scene: Scene, time: number): Vector {
  return poleAt(scene, sampleAt(scene, time))
}

const POINTS: readonly (readonly [string, Vector])[] = [
  ['up', [0, 0, 1]],
  ['down', [0, 0, -1]],
  ['east', [1, 0, 0]],
  ['west', [-1, 0, 0]],
  ['north', [0, 1, 0]],
  ['south', [0, -1, 0]],
]

/** A direction in words where it is one of six, in components where it is not. */
export function directionInWords(direction: Vector): string {
  const close = POINTS.find(([, point]) => point.every((part, i) => Math.abs(part - (direction[i] ?? 0)) < 5e-4))
  return close ? close[0] : componentsOf(direction)
}

export function componentsOf(direction: readonly number[]): string {
  return `(${direction.map((part) => signed(part)).join(', ')})`
}

function signed(part: number): string {
  const text = Math.abs(part).toFixed(3)
  return part < -5e-4 ? `−${text}` : text
}

export function degrees(angle: number, digits = 2): string {
  const text = ((angle * 180) / Math.PI).toFixed(digits)
  return `${Number(text) === 0 ? text.replace('-', '') : text.replace('-', '−')}°`
}

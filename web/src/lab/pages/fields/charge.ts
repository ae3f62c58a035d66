/** What the header of a charge's scene holds besides a scene's. */
import type { Scene, Triple } from '../../../viewer/scene'
import type { TableRow } from './dictionary'

export interface ChargeHeader {
  /** V/m, in the support frame. */
  E: Triple
  /** T, along the normal. */
  B: Triple
  charge: number
  /** m/s; null without a magnetic field. */
  drift: Triple | null
  table: TableRow[]
  /** Greatest distance between the paths of ball and charge, each by its own formulas, m. */
  apart: number
}

export function chargeOf(scene: Scene): ChargeHeader {
  return scene.header as unknown as ChargeHeader
}

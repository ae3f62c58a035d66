/** How a hand moved at last: whether what it lets go of is thrown, and how fast. */
import type { Vector3 } from 'three'
import type { Triple } from './scene'

const LAST = 100 // ms that tell
const BUSY = 500 // ms: a page may be so busy that it hears of a moving hand no sooner
const STILL = 80 // ms without a move: it is put down

export class Swing {
  private moves: { at: number; place: Vector3 }[] = []

  /** `least`: what a hand moves by that means to hold still, m. */
  constructor(private readonly least: number) {}

  add(at: number, place: Vector3): void {
    const recent = this.moves.filter((move) => at - move.at <= LAST)
    this.moves = recent.length ? recent : this.moves.slice(-1).filter((move) => at - move.at <= BUSY)
    this.moves.push({ at, place: place.clone() })
  }

  /** The velocity at `now`, ms, in m/s; null where it is put down. */
  velocity(now: number): Triple | null {
    const [first] = this.moves
    const last = this.moves.at(-1)
    if (!first || !last || last.at === first.at || now - last.at > STILL) return null
    const gone = last.place.clone().sub(first.place)
    return gone.length() <= this.least ? null : gone.divideScalar((last.at - first.at) / 1000).toArray()
  }
}

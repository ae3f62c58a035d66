/** How sharp a moving picture may be: where frames come too slowly it is drawn with fewer pixels; a still one never is. */
export class Pace {
  private slow = 0
  private last: number | null = null

  /** Begin with a share of the full number of pixels to a side. */
  constructor(public share = 1) {}

  /** A frame is to be drawn at `now`, ms; tells whether the share has changed. */
  frame(now: number): boolean {
    const passed = this.last === null ? 0 : now - this.last
    this.last = now
    if (passed <= SLOW) this.slow = Math.max(0, this.slow - 1)
    else this.slow += passed > 3 * SLOW ? 3 : 1
    if (this.slow < PATIENCE || this.share <= LEAST) return false
    this.share = Math.max(LEAST, 0.75 * this.share)
    this.slow = 0
    return true
  }

  /** Play has stopped: what comes next is not late. */
  rest(): void {
    this.last = null
    this.slow = 0
  }
}

const SLOW = 42 // ms
const PATIENCE = 5 // frames
/** The smallest share: fewer pixels show too little. */
export const LEAST = 0.42

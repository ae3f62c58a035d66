/** How sharp a picture is drawn: in full at rest, with fewer pixels while it moves too slowly or the processor must draw it. */
import { LEAST, Pace } from './pace'

/** What is drawn with a share of its pixels to a side. */
export interface Sharpened {
  /** Each pixel is dear: a full picture takes longer than a hand that drags would wait. */
  readonly byProcessor: boolean
  sharpen(share: number): void
}

const COARSE = 0.5
const CALM = 900 // ms without a change: a picture in full takes time that a hand which moves on would wait for

export class Sharpness {
  private readonly pace: Pace
  private resting = false
  private calm: ReturnType<typeof setTimeout> | undefined

  /** `draw` is called when a picture that was drawn coarsely is to be drawn in full. */
  constructor(
    private readonly picture: Sharpened,
    private readonly draw: () => void,
  ) {
    this.pace = new Pace(picture.byProcessor ? COARSE : 1)
  }

  /** A frame of play is to be drawn at `now`, ms. */
  frame(now: number): void {
    clearTimeout(this.calm)
    this.pace.frame(now)
    this.picture.sharpen(this.pace.share)
  }

  /** What is drawn next is the last change for now. */
  rest(): void {
    this.resting = true
  }

  /** What is drawn next has changed, or its play has stopped. */
  changed(): void {
    this.pace.rest()
    clearTimeout(this.calm)
    const { resting } = this
    this.resting = false
    if (resting || !this.picture.byProcessor) {
      this.picture.sharpen(1)
      return
    }
    this.picture.sharpen(LEAST) // a hand that drags would see the path bend at once rather than see it crisp
    this.calm = setTimeout(() => {
      this.picture.sharpen(1)
      this.draw()
    }, CALM)
  }

  dispose(): void {
    clearTimeout(this.calm)
  }
}

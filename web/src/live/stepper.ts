/** One step after another of an explicit Runge-Kutta method of order 8, each as long as its error allows. */
import type { Method, Numbers } from './law'

export type Rates = (t: number, y: Numbers) => Numbers

const STAGES = 12
const SHRINKS = 0.333
const GROWS = 6

export class Stepper {
  /** Where the last step began, how long it was, and where it led. */
  before: Numbers
  length = 0
  private slopes: Numbers[] = []
  private bent: number[][] | null = null
  private next: number
  private rejected = false

  constructor(
    private readonly rates: Rates,
    private readonly method: Method,
    private readonly sizes: (y: Numbers) => number[],
    private readonly tolerance: number,
    public time: number,
    public state: Numbers,
    first: number,
  ) {
    this.before = state
    this.next = first
    this.slopes[0] = rates(time, state)
  }

  /** Go a step on, no farther than an instant; false where no step is short enough. */
  step(limit: number): boolean {
    const first = this.slopes[STAGES] ?? (this.slopes[0] as Numbers)
    const scale = Math.abs(this.time) + Math.abs(limit)
    for (;;) {
      const left = limit - this.time
      const length = this.next > 0.999 * left ? left : this.next > 0.5 * left ? 0.5 * left : this.next
      if (!(length > 4e-16 * scale) && length < left) return false
      const slopes: Numbers[] = [first]
      this.stages(slopes, this.time, this.state, length, 1, STAGES - 1)
      const after = this.sum(slopes, this.state, length, STAGES - 1)
      slopes[STAGES] = this.rates(this.time + length, after)
      const error = this.error(slopes, after, length)
      if (error < 1) {
        const most = this.rejected ? 1 : GROWS
        this.next = length * Math.min(most, error === 0 ? GROWS : 0.9 * error ** (-1 / 8))
        this.rejected = false
        this.before = this.state
        this.length = length
        this.slopes = slopes
        this.bent = null
        this.time = length === left ? limit : this.time + length
        this.state = after
        return true
      }
      this.rejected = true
      this.next = length * (Number.isFinite(error) ? Math.max(SHRINKS, 0.9 * error ** (-1 / 8)) : 0.2)
    }
  }

  /** The state at a share of the last step, by an interpolation of order 7. */
  within(share: number): number[] {
    const bent = this.bent ?? this.bend()
    this.bent = bent
    const found = new Array<number>(this.state.length)
    for (let i = 0; i < found.length; i++) {
      let sum = 0
      for (let j = bent.length - 1; j >= 0; j--)
        sum = (sum + (bent[j] as number[])[i]!) * (j % 2 === bent.length % 2 ? 1 - share : share)
      found[i] = this.before[i]! + sum
    }
    return found
  }

  /** The state after a part of the last step, by a step of its own from where that began. */
  after(length: number): number[] {
    const from = this.time - this.length
    const slopes: Numbers[] = [this.slopes[0] as Numbers]
    this.stages(slopes, from, this.before, length, 1, STAGES - 1)
    return this.sum(slopes, this.before, length, STAGES - 1)
  }

  private stages(slopes: Numbers[], from: number, y: Numbers, length: number, first: number, last: number): void {
    for (let s = first; s <= last; s++)
      slopes[s] = this.rates(from + this.method.c[s - 1]! * length, this.sum(slopes, y, length, s - 1))
  }

  private sum(slopes: Numbers[], y: Numbers, length: number, row: number): number[] {
    const weights = this.method.a[row] as number[]
    const found = new Array<number>(y.length)
    for (let i = 0; i < found.length; i++) {
      let sum = 0
      for (let j = 0; j < weights.length; j++) {
        const weight = weights[j]!
        if (weight !== 0) sum += weight * (slopes[j] as Numbers)[i]!
      }
      found[i] = y[i]! + length * sum
    }
    return found
  }

  private error(slopes: Numbers[], after: Numbers, length: number): number {
    const { e3, e5 } = this.method
    const [here, there] = [this.sizes(this.state), this.sizes(after)]
    let [third, fifth] = [0, 0]
    for (let i = 0; i < after.length; i++) {
      let [a, b] = [0, 0]
      for (let j = 0; j <= STAGES; j++) {
        const slope = (slopes[j] as Numbers)[i]!
        a += e3[j]! * slope
        b += e5[j]! * slope
      }
      const size = this.tolerance * Math.max(here[i]!, there[i]!)
      third += (a / size) ** 2
      fifth += (b / size) ** 2
    }
    const both = fifth + 0.01 * third
    return both === 0 ? 0 : (length * fifth) / Math.sqrt(both * after.length)
  }

  /** Take the stages that only the interpolation needs. */
  private bend(): number[][] {
    const { length, slopes } = this
    const from = this.time - length
    const all = slopes.slice(0, STAGES + 1)
    this.stages(all, from, this.before, length, STAGES + 1, STAGES + 3)
    const rows: number[][] = [[], [], [], ...this.method.d.map(() => [] as number[])]
    for (let i = 0; i < this.state.length; i++) {
      const change = this.state[i]! - this.before[i]!
      const [first, last] = [(all[0] as Numbers)[i]!, (all[STAGES] as Numbers)[i]!]
      rows[0]![i] = change
      rows[1]![i] = length * first - change
      rows[2]![i] = 2 * change - length * (last + first)
      this.method.d.forEach((weights, k) => {
        let sum = 0
        for (let j = 0; j < weights.length; j++) sum += weights[j]! * (all[j] as Numbers)[i]!
        rows[3 + k]![i] = length * sum
      })
    }
    return rows
  }
}

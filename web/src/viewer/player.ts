/** A clock that plays a run: it knows nothing of what is drawn. */
export class Player {
  begin = 0
  duration = 0
  time = 0
  speed = 1
  loop = false
  playing = false
  private last: number | null = null

  get end(): number {
    return this.begin + this.duration
  }

  /** Take another run; the time stays where it was if that is asked for and lies within it. */
  load(begin: number, duration: number, keepTime: boolean): void {
    const share = this.time
    this.begin = begin
    this.duration = duration
    this.last = null
    this.time = keepTime ? this.within(share) : begin
  }

  play(): void {
    if (this.time >= this.end) this.time = this.begin
    this.playing = this.duration > 0
    this.last = null
  }

  pause(): void {
    this.playing = false
    this.last = null
  }

  seek(time: number): void {
    this.time = this.within(time)
  }

  /**
   * Go on to the instant `now` (ms) of the page's clock; tells whether the end was reached and play stopped.
   * After a long absence, as of a hidden page, it goes on from about where it was instead of leaping.
   */
  tick(now: number): boolean {
    if (!this.playing) return false
    const passed = this.last === null ? 0 : Math.max(0, now - this.last)
    this.last = now
    this.time += (Math.min(passed, LONGEST_FRAME) / 1000) * this.speed
    if (this.time < this.end) return false
    if (this.loop) {
      this.time = this.begin + ((this.time - this.begin) % this.duration)
      return false
    }
    this.time = this.end
    this.pause()
    return true
  }

  private within(time: number): number {
    return Number.isFinite(time) ? Math.min(Math.max(time, this.begin), this.end) : this.begin
  }
}

const LONGEST_FRAME = 400 // ms

export const SPEEDS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10] as const

const SHORTEST = 1.5 // s that a film takes
const FASTEST = 100 // rad/s that an eye follows at sixty pictures a second

/** The speed at which a run of this duration, s, turning at most so fast, rad/s, can be watched: never above the true one. */
export function watchable(duration: number, turning: number): number {
  const most = Math.min(duration / SHORTEST, turning > 0 ? FASTEST / turning : 1)
  return [...SPEEDS].reverse().find((speed) => speed <= 1 && speed <= most) ?? SPEEDS[0]
}

/** The next slower or faster of the usual speeds. */
export function nextSpeed(speed: number, direction: 1 | -1): number {
  const sorted = direction > 0 ? SPEEDS : [...SPEEDS].reverse()
  return sorted.find((candidate) => (candidate - speed) * direction > 1e-9) ?? speed
}

/** A motion followed through its phases, from a start that is placed anew, to its end or to where the law ends. */
import type { SceneEvent } from '../viewer/scene'
import type { Law, Numbers, Phase } from './law'
import { Stepper } from './stepper'

export type Happened = SceneEvent

export interface Course {
  time: number[]
  /** One row a sample, as `law.film` names them. */
  rows: number[][]
  /** The code of the phase, of each sample. */
  phase: number[]
  events: Happened[]
  /** The last event, if it ended the motion early. */
  ended: Happened | null
  /** All numbers of the system, as `law.parameters` names them. */
  parameters: number[]
  /** The number of the headline by theory, if a formula has it. */
  promised: number | null
}

const FRAMES = 600 // of a film, at least
const TURN = 0.4 // rad from one to the next, at most
const MOST_FRAMES = 20_000
const MOST_STEPS = 200_000
const MOST_EVENTS = 5_000
const [MANY, MANY_WITHIN] = [50, 1e-3] // events, and the share of the time in which the motion changes
const STILL = 1e-12 // of the speeds at hand: less has ended
const FIRST = 1e-4 // share of that time for a first step
const LOOKS = [0.25, 0.5, 0.75, 1]
const FORCES = ['lift', 'slip', 'start', 'jam'] // may be broken as a phase begins
// The laws that are printed begin these with a first billionth: too much where what holds the body gives way slowly.
const BEGINS = ['slip', 'start']
const GIVES_WAY = 'What holds the body gives way, and it begins to slip or to turn'
const NOT_FOLLOWED = 'Changes too quickly to be followed here'
const NO_ANSWER = 'Comes where the law has no answer'
const PULLED = 'Friction without limit would have to hold the body down, which no support does'
const BEYOND = 'Starts beyond where the law holds: move a slider back'
const CHATTERS = 'Chatters: more events than can be followed'

/** Follow a motion; at some instants, or at as many as a film needs. */
export function follow(law: Law, values: Numbers, times?: readonly number[]): Course {
  return new Follower(law, values, times).run()
}

class Follower {
  private readonly p: number[]
  private readonly u: number[] = []
  private readonly end: number
  private readonly found: Course
  private phase: Phase
  private e: Numbers = []
  private t: number
  private y: Numbers
  private next = 0
  private steps = 0

  constructor(
    private readonly law: Law,
    values: Numbers,
    private readonly times: readonly number[] | undefined,
  ) {
    const placed = law.placed(values)
    this.y = placed.slice(0, law.size)
    this.p = placed.slice(law.size)
    this.t = law.begin
    this.end = law.begin + law.duration
    this.phase = law.phases[law.phase] as Phase
    this.found = { time: [], rows: [], phase: [], events: [], ended: null, parameters: this.p, promised: null }
  }

  run(): Course {
    const { law } = this
    this.begin()
    this.found.promised = law.promised?.(this.t, this.y, this.p, this.u)[0] ?? null
    const first = this.events(this.t, this.y)
    const beyond = this.phase.names.find((name, i) => !FORCES.includes(name) && name in this.law.ends && first[i]! < 0)
    if (beyond) this.stop(beyond, BEYOND)
    if (!this.times) this.put(this.t, this.y)
    else this.sampleAt(this.t, () => this.y)
    while (!this.found.ended && this.t < this.end) this.stretch()
    return this.found
  }

  private begin(): void {
    const { eventParameters } = this.phase
    this.e = eventParameters ? eventParameters(this.t, this.y, this.p, this.u) : []
  }

  private events(t: number, y: Numbers): number[] {
    return this.phase.events(t, y, this.p, this.u, this.e)
  }

  /** Go on by one law until it ends. */
  private stretch(): void {
    const { law, phase, p, u } = this
    let here = this.events(this.t, this.y)
    const broken = phase.names.findIndex((name, i) => FORCES.includes(name) && here[i]! < 0)
    if (broken >= 0) {
      this.pass(phase.names[broken] as string, true)
      return
    }
    const stepper = new Stepper(
      (t, y) => phase.rates(t, y, p, u),
      law.method,
      (y) => this.sizes(y),
      law.tolerance,
      this.t,
      this.y,
      FIRST * law.moment,
    )
    let fresh = true // what is zero as a phase begins has not fallen through it
    while (stepper.time < this.end) {
      if (++this.steps > MOST_STEPS) {
        this.stop('steps', NOT_FOLLOWED)
        return
      }
      if (!stepper.step(this.end)) {
        this.stop('singular', NO_ANSWER)
        return
      }
      const from = stepper.time - stepper.length
      let share = 0
      for (const look of LOOKS) {
        const there = this.events(from + look * stepper.length, look === 1 ? stepper.state : stepper.within(look))
        const [low, which] = this.crossing(stepper, from, [share, look], here, there, fresh)
        if (which >= 0) {
          const length = low * stepper.length
          const [t, y] = [from + length, stepper.after(length)]
          this.sample(stepper, from, t)
          this.t = t
          this.y = y
          this.pass(phase.names[which] as string)
          return
        }
        here = there
        share = look
        fresh = false
      }
      this.sample(stepper, from, stepper.time)
      this.t = stepper.time
      this.y = stepper.state
    }
  }

  /** The first event function that falls through zero between two shares of a step, and at which share it does. */
  private crossing(
    stepper: Stepper,
    from: number,
    [low, high]: [number, number],
    here: Numbers,
    there: Numbers,
    fresh: boolean,
  ): [number, number] {
    let [first, which] = [Number.POSITIVE_INFINITY, -1]
    for (let i = 0; i < there.length; i++) {
      const above = here[i]! > 0 || (fresh && here[i]! > -STILL)
      if (!above || !(there[i]! < 0)) continue
      const at = this.root(stepper, from, i, low, high)
      if (at < first) [first, which] = [at, i]
    }
    return [first, which]
  }

  /** Where an event function is zero: halved until a step of its own has come as near as floats can. */
  private root(stepper: Stepper, from: number, index: number, low: number, high: number): number {
    const value = (share: number) =>
      this.events(from + share * stepper.length, stepper.after(share * stepper.length))[index]!
    let [a, b] = [low, high]
    let [fa, fb] = [Math.max(value(a), 0), value(b)]
    if (fb >= 0) return b
    for (let i = 0; i < 100 && b - a > 4e-16; i++) {
      // Illinois: a secant that halves what stays, so that both ends come nearer.
      let middle = a + ((b - a) * fa) / (fa - fb)
      if (!(middle > a && middle < b) || i % 5 === 4) middle = 0.5 * (a + b)
      if (middle <= a || middle >= b) break
      const f = value(middle)
      if (f < 0) [b, fb, fa] = [middle, f, 0.5 * fa]
      else [a, fa, fb] = [middle, f, 0.5 * fb]
      if (f === 0) return middle
    }
    return b
  }

  /** Follow what comes after an event, or where a phase cannot begin at all: another, the same again, or nothing. */
  private pass(event: string, atOnce = false): void {
    const { law, phase, p, u } = this
    const name = event.replace('near ', '')
    if (this.goesOn(name)) {
      this.begin()
      return
    }
    if (BEGINS.includes(name) && !atOnce) {
      this.stop(name, GIVES_WAY)
      return
    }
    const reset = phase.resets[name]
    if (!reset) {
      this.stop(name, law.ends[name] ?? NO_ANSWER)
      return
    }
    const code = reset.choice?.(this.t, this.y, p, u)[0]
    if (code === law.nothing) {
      this.stop('spot', law.ends.spot ?? NO_ANSWER)
      return
    }
    const names = Object.keys(reset.states)
    const follows = names.find((each) => code === undefined || law.codes[each] === code) ?? (names[0] as string)
    const y = (reset.states[follows] as (typeof reset.states)[string])(this.t, this.y, p, u)
    if (!y.every(Number.isFinite)) {
      this.stop(name, NO_ANSWER)
      return
    }
    const last = this.found.events.at(-1)
    if (name === 'land' && last?.kind === 'lift' && this.t - last.time < MANY_WITHIN * law.moment) {
      this.found.events.pop()
      this.stop('lift', PULLED)
      return
    }
    const same = follows === phase.name
    this.phase = law.phases[follows] as Phase
    this.y = y
    const text = law.said[name]?.[follows]
    const told = text && this.t > law.begin && !(same && name === 'slip')
    if (told) this.found.events.push({ time: this.t, kind: name, text: timed(text, this.t) })
    this.begin()
    if (!this.times) this.put(this.t, this.y)
    this.checkCount()
  }

  /** Whether slip or turning was only at its slowest, and did not end. */
  private goesOn(name: string): boolean {
    if (name !== 'grip' && name !== 'stop') return false
    const { names } = this.phase
    const near = names.indexOf(`near ${name}`)
    const which = names.filter((each) => each.startsWith('near ')).indexOf(`near ${name}`)
    const least = this.e[4 * which]!
    const square = this.events(this.t, this.y)[near]! + least
    return square > 16 * least
  }

  /** Ω of a state of a phase, rad/s. */
  private turning(phase: Phase, y: Numbers): number[] {
    const { law, t, p, u } = this
    return phase.film(t, y, p, u).slice(law.turning, law.turning + 3)
  }

  private checkCount(): void {
    const { events } = this.found
    const many = events[events.length - MANY]
    const close = many && this.t - many.time < MANY_WITHIN * this.law.moment
    if (close || events.length > MOST_EVENTS) this.stop('chatter', CHATTERS)
  }

  private stop(kind: string, text: string): void {
    const event = { time: this.t, kind, text: this.t > this.law.begin ? timed(text, this.t) : text }
    this.put(this.t, this.y)
    this.found.events.push(event)
    this.found.ended = event
  }

  /** What an error of each number of the state is measured against. */
  private sizes(y: Numbers): number[] {
    const { arm, moment } = this.law
    const found = new Array<number>(y.length)
    for (const [first, behind, kind] of this.phase.groups) {
      const least = { Omega: 1 / moment, s: arm / moment, V: arm / moment, q: 1, support: 1 }[kind] ?? arm
      let square = 0
      for (let i = first; i < behind; i++) square += y[i]! * y[i]!
      const size = Math.max(least, Math.sqrt(square))
      for (let i = first; i < behind; i++) found[i] = size
    }
    return found
  }

  private sample(stepper: Stepper, from: number, until: number): void {
    const within = (t: number) => (t === stepper.time ? stepper.state : stepper.within((t - from) / stepper.length))
    if (this.times) {
      this.sampleAt(until, within)
      return
    }
    const turning = Math.hypot(...this.turning(this.phase, this.y))
    const span = until - from
    const room = Math.max(1, MOST_FRAMES - this.found.time.length)
    const frames = Math.max((FRAMES * span) / this.law.duration, (turning * span) / TURN)
    const count = Math.min(Math.ceil(frames), room)
    for (let i = 1; i <= count; i++)
      this.put(i < count ? from + (span * i) / count : until, within(i < count ? from + (span * i) / count : until))
  }

  private sampleAt(until: number, within: (t: number) => Numbers): void {
    const times = this.times as readonly number[]
    for (; this.next < times.length && times[this.next]! <= until; this.next++) {
      const t = times[this.next]!
      this.put(t, within(t))
    }
  }

  private put(t: number, y: Numbers): void {
    const { time } = this.found
    if (time.length && t === time[time.length - 1]) {
      if (this.times) return
      time.pop()
      this.found.rows.pop()
      this.found.phase.pop()
    }
    time.push(t)
    this.found.rows.push(this.phase.film(t, y, this.p, this.u))
    this.found.phase.push(this.phase.code)
  }
}

function timed(text: string, time: number): string {
  return `${text} at ${Number(time.toPrecision(4))} s`
}

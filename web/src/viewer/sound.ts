/** What a run sounds like, made in the page from its own numbers: rolling, slipping, landings. Off until it is asked for. */
import { PHASE, type Scene } from './scene'
import { sampleBefore } from './track'

/** Of one instant. */
export interface Heard {
  /** Speed of the body's contact about its centre, m/s: how fast it rolls. */
  rolling: number
  /** m/s */
  slip: number
}

/** A landing. */
export interface Impact {
  time: number
  /** m |ΔV|, N s */
  impulse: number
}

const LANDINGS = ['land', 'settle']
const AHEAD = 0.03 // s in which a loudness changes, so that nothing clicks
const HALF_LOUD = 0.5 // m/s
const QUIETEST = 0.02 // of the strongest landing: softer ones are not heard
const LOUD = { rolling: 0.35, slip: 0.25, impact: 0.7 }
const NOISE = 2 // s until it comes again
const SUM = 4 // of amplitudes, to which they are rounded off rather than cut

/** Of several bodies on one stage the fastest is heard. */
export function heardAt(scenes: readonly Scene[], time: number): Heard {
  const found: Heard = { rolling: 0, slip: 0 }
  for (const { columns } of scenes) {
    const i = sampleBefore(columns.time, time)
    if (columns.phase?.[i] === PHASE.flight) continue
    const { position, contact, angular_velocity: turning, curve_slip: slip } = columns
    if (contact && turning) {
      const at = (column: Float32Array) => [column[3 * i]!, column[3 * i + 1]!, column[3 * i + 2]!] as const
      const [p, c, [a, b, d]] = [at(position), at(contact), at(turning)]
      const [x, y, z] = [c[0] - p[0], c[1] - p[1], c[2] - p[2]]
      found.rolling = Math.max(found.rolling, finite(Math.hypot(b * z - d * y, d * x - a * z, a * y - b * x)))
    }
    if (columns.phase?.[i] === PHASE.slipping) found.slip = Math.max(found.slip, finite(slip?.[i] ?? 0))
  }
  return found
}

/** The landings of the runs, in the order of time. */
export function impactsOf(scenes: readonly Scene[]): Impact[] {
  const found = scenes.flatMap(({ header, columns: { time, velocity } }) =>
    (header.events ?? []).flatMap((event): Impact[] => {
      if (!velocity || !LANDINGS.includes(event.kind)) return []
      const before = Math.max(0, sampleBefore(time, event.time - 1e-9))
      let after = before
      while (after + 1 < time.length && time[after]! <= event.time) after++
      const change = [0, 1, 2].map((axis) => velocity[3 * after + axis]! - velocity[3 * before + axis]!)
      return [{ time: event.time, impulse: finite(header.body.mass * Math.hypot(...change)) }]
    }),
  )
  return found.sort((one, other) => one.time - other.time)
}

/** From silence at 0 up to 1. */
export function loudness(speed: number): number {
  return Math.sqrt(speed / (speed + HALF_LOUD))
}

const strength = ({ impulse }: Impact) => impulse
const finite = (value: number) => (Number.isFinite(value) ? value : 0)

interface Voice {
  filter: BiquadFilterNode
  gain: GainNode
}

export class Sound {
  /** For as long as the page is there. */
  private static wanted = false
  private static context: AudioContext | null = null
  private static outlet: AudioNode
  private rolling: Voice | null = null
  private slipping: Voice | null = null
  private scenes: readonly Scene[] = []
  private impacts: Impact[] = []
  private last = Number.NaN

  get on(): boolean {
    return Sound.wanted
  }

  set on(on: boolean) {
    Sound.wanted = on
    if (on) this.open()
    else this.rest()
  }

  set runs(scenes: readonly Scene[]) {
    this.scenes = scenes
    this.impacts = impactsOf(scenes)
    this.last = Number.NaN
  }

  /** The film plays on to this time. */
  at(time: number): void {
    if (!Sound.wanted) return
    const context = this.open()
    if (!context || !this.rolling || !this.slipping) return
    if (context.state === 'suspended') void context.resume()
    const { rolling, slip } = heardAt(this.scenes, time)
    turn(this.rolling, context, LOUD.rolling * loudness(rolling), 90 + 500 * rolling)
    turn(this.slipping, context, LOUD.slip * loudness(slip), 1200 + 1500 * slip)
    const impulse = Math.max(0, ...this.impacts.filter((one) => one.time > this.last && one.time <= time).map(strength))
    const share = impulse / Math.max(...this.impacts.map(strength))
    if (share > QUIETEST) strike(context, Sound.outlet, share)
    this.last = time
  }

  /** To another time: what lies between is not heard. */
  leap(): void {
    this.last = Number.NaN
  }

  /** The film stands: nothing is heard. */
  rest(): void {
    this.last = Number.NaN
    const { context } = Sound
    if (!context) return
    for (const voice of [this.rolling, this.slipping]) voice?.gain.gain.setTargetAtTime(0, context.currentTime, AHEAD)
  }

  dispose(): void {
    this.rest()
    for (const voice of [this.rolling, this.slipping]) voice?.gain.disconnect()
    this.rolling = null
    this.slipping = null
  }

  private open(): AudioContext | null {
    if (typeof AudioContext === 'undefined') return null
    if (!Sound.context) {
      Sound.context = new AudioContext()
      Sound.outlet = outletOf(Sound.context)
    }
    const { context, outlet } = Sound
    if (!this.rolling) {
      const noise = noiseOf(context)
      this.rolling = voice(context, noise, outlet, 'lowpass', 1)
      this.slipping = voice(context, noise, outlet, 'bandpass', 4)
    }
    return context
  }
}

/** What all is heard through: however much sounds at once, it is rounded off below 1, and nothing clips. */
function outletOf(context: AudioContext): AudioNode {
  const [share, soft] = [context.createGain(), context.createWaveShaper()]
  share.gain.value = 1 / SUM
  soft.curve = Float32Array.from({ length: 1025 }, (_, i) => Math.tanh(SUM * (i / 512 - 1)))
  share.connect(soft).connect(context.destination)
  return share
}

function noiseOf(context: AudioContext): AudioBufferSourceNode {
  const buffer = context.createBuffer(1, NOISE * context.sampleRate, context.sampleRate)
  const samples = buffer.getChannelData(0)
  for (let i = 0; i < samples.length; i++) samples[i] = 2 * Math.random() - 1
  const source = context.createBufferSource()
  source.buffer = buffer
  source.loop = true
  source.start()
  return source
}

function voice(
  context: AudioContext,
  noise: AudioNode,
  outlet: AudioNode,
  type: BiquadFilterType,
  sharpness: number,
): Voice {
  const filter = context.createBiquadFilter()
  filter.type = type
  filter.Q.value = sharpness
  const gain = context.createGain()
  gain.gain.value = 0
  noise.connect(filter).connect(gain).connect(outlet)
  return { filter, gain }
}

function turn({ filter, gain }: Voice, context: AudioContext, loud: number, pitch: number): void {
  gain.gain.setTargetAtTime(loud, context.currentTime, AHEAD)
  filter.frequency.setTargetAtTime(Math.min(pitch, 6000), context.currentTime, AHEAD)
}

/** A knock, the deeper the harder. */
function strike(context: AudioContext, outlet: AudioNode, share: number): void {
  const [tone, gain, now] = [context.createOscillator(), context.createGain(), context.currentTime]
  tone.frequency.setValueAtTime(420 - 200 * share, now)
  tone.frequency.exponentialRampToValueAtTime(90, now + 0.12)
  gain.gain.setValueAtTime(LOUD.impact * Math.sqrt(share), now)
  gain.gain.exponentialRampToValueAtTime(1e-4, now + 0.18)
  tone.connect(gain).connect(outlet)
  tone.start(now)
  tone.stop(now + 0.2)
}

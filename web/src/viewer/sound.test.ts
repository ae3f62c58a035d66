import { afterEach, expect, test, vi } from 'vitest'
import type { Scene } from './scene'
import { heardAt, impactsOf, loudness, Sound } from './sound'

// A ball of 10 cm over z = 0: it rolls at 3 rad/s about y, flies, lands at t = 2 with ΔV = 4 m/s upwards, and slips.
const columns = {
  time: Float64Array.of(0, 1, 2, 2.5, 3),
  position: Float32Array.from({ length: 15 }, (_, i) => (i % 3 === 2 ? 0.1 : 0)),
  contact: new Float32Array(15),
  angular_velocity: Float32Array.from({ length: 15 }, (_, i) => (i % 3 === 1 ? 3 : 0)),
  velocity: Float32Array.of(0, 0, 0, 0, 0, -2, 0, 0, -2, 0, 0, 2, 0, 0, 2),
  phase: Uint8Array.of(0, 2, 2, 1, 1),
  curve_slip: Float32Array.of(0, Number.NaN, Number.NaN, 0.7, 0.7),
}
const header = { body: { mass: 0.5 }, events: [{ time: 2, kind: 'land', text: '' }] }
const scene = { header, columns } as unknown as Scene

test('it is told from the run’s own numbers', () => {
  expect(heardAt([scene], 0.5).rolling).toBeCloseTo(0.3, 6)
  expect(heardAt([scene], 1.5)).toEqual({ rolling: 0, slip: 0 })
  expect(heardAt([scene], 2.7).slip).toBeCloseTo(0.7, 6)
  expect(impactsOf([scene])).toEqual([{ time: 2, impulse: 2 }])
  expect([loudness(0), loudness(0.5)]).toEqual([0, Math.sqrt(0.5)])
})

class Context {
  static made: Context[] = []
  readonly loud: number[] = []
  readonly struck: number[] = []
  readonly sampleRate = 10
  readonly currentTime = 0
  readonly state = 'running'
  readonly destination = {}
  constructor() {
    Context.made.push(this)
  }
  private node = (more: object) => ({ connect: (to: unknown) => to, disconnect: () => undefined, ...more })
  createBuffer = () => ({ getChannelData: () => new Float32Array(20) })
  createBufferSource = () => this.node({ start: () => undefined })
  createWaveShaper = () => this.node({})
  createBiquadFilter = () => this.node({ Q: {}, frequency: { setTargetAtTime: () => undefined } })
  createGain = () =>
    this.node({
      gain: {
        setTargetAtTime: (loud: number) => this.loud.push(loud),
        setValueAtTime: () => undefined,
        exponentialRampToValueAtTime: () => undefined,
      },
    })
  createOscillator = () =>
    this.node({
      frequency: { setValueAtTime: () => undefined, exponentialRampToValueAtTime: () => undefined },
      start: (when: number) => this.struck.push(when),
      stop: () => undefined,
    })
}

afterEach(() => vi.unstubAllGlobals())

test('nothing sounds until it is asked for, nothing while the film stands, a landing once', () => {
  vi.stubGlobal('AudioContext', Context)
  const sound = new Sound()
  sound.runs = [scene]
  sound.at(0.5)
  expect(Context.made).toEqual([])
  sound.on = true
  const context = Context.made[0]!
  sound.at(0.5)
  expect(context.loud.at(-2)).toBeGreaterThan(0)
  sound.rest()
  expect(context.loud.slice(-2)).toEqual([0, 0])
  for (const time of [1.9, 2.1, 2.3]) sound.at(time)
  expect(context.struck).toHaveLength(1)
  sound.leap()
  sound.at(2.9)
  expect(context.struck).toHaveLength(1)
  expect(new Sound().on).toBe(true)
  sound.on = false
  expect(context.loud.slice(-2)).toEqual([0, 0])
  sound.at(0.5)
  expect(context.loud.slice(-2)).toEqual([0, 0])
})

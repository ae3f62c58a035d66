/** The motion in words, for who does not see the stage: "ball 12 cm from the axis, moving outwards, slowing". */
import { t } from '../languages/translate'
import type { Scene, Triple } from './scene'

/** Every word of it, by which the catalogues have it. */
export const WORDS = {
  body: 'body',
  at: (time: string, said: string) => `${time} s: ${said}.`,
  from: { axis: (far: string) => `${far} from the axis`, start: (far: string) => `${far} from where it began` },
  on: { axis: 'on the axis', start: 'where it began' },
  way: {
    out: 'moving outwards',
    in: 'moving inwards',
    away: 'moving away',
    back: 'coming back',
    across: 'moving across',
  },
  round: { left: 'going round anticlockwise', right: 'going round clockwise' },
  pace: { faster: 'getting faster', slower: 'slowing', even: 'at an even speed' },
  rest: 'at rest',
  spins: 'spinning on the spot',
  phase: ['', 'slipping', 'in the air', ''],
  describe: 'Describe the motion',
  paces: [
    [0, 'not at all'],
    [3, 'every 3 seconds'],
    [5, 'every 5 seconds'],
    [10, 'every 10 seconds'],
  ] as const,
} as const

const STILL = 0.01 // of the greatest speed of the run
const MOSTLY = 0.4 // the share of the speed that a direction must have to be named
const CHANGES = 0.02 // of the greatest speed, over a twenty-fifth of the run

const row = (values: ArrayLike<number> | undefined, at: number): Triple => [
  values?.[3 * at] ?? 0,
  values?.[3 * at + 1] ?? 0,
  values?.[3 * at + 2] ?? 0,
]

/** "12 cm", "3.4 m", "8 mm": two digits are what an ear takes in. */
function length(metres: number): string {
  const [scale, unit] = metres > 0.995 ? [1, 'm'] : metres > 0.00995 ? [100, 'cm'] : [1000, 'mm']
  return `${Number((metres * scale).toPrecision(2))} ${unit}`
}

/** Does the support turn, so that it has an axis to speak of? */
function turns(orientation: Float32Array | undefined): boolean {
  return orientation?.some((value, i) => Math.abs(value - orientation[i % 4]!) > 1e-6) ?? false
}

/** Where the body of a run is at a time, where it goes, and how. */
export function described(scene: Scene, time: number): string {
  const { columns, header } = scene
  const { position, velocity, time: times } = columns
  let at = 0
  while (at + 1 < times.length && (times[at + 1] ?? 0) <= time) at += 1
  const speeds = Array.from(times, (_, i) => Math.hypot(...row(velocity, i)))
  const most = speeds.reduce((one, other) => Math.max(one, other), 0)
  const speed = speeds[at] ?? 0
  const { support } = header
  const round = support.rim !== null || (support.flat && turns(columns.support_orientation))
  const from = round ? 'axis' : 'start'
  const home: Triple = round ? [0, 0, 0] : row(position, 0)
  const [x, y, z] = row(position, at).map((value, i) => value - home[i]!) as Triple
  const far = round ? Math.hypot(x, y) : Math.hypot(x, y, z)
  const said = [far < 1e-4 ? WORDS.on[from] : WORDS.from[from](length(far))]

  const turning = Math.hypot(...row(columns.angular_velocity, at)) * header.body.radius
  if (speed <= STILL * Math.max(most, turning)) said.push(turning > speed ? WORDS.spins : WORDS.rest)
  else {
    const [vx, vy, vz] = row(velocity, at)
    const outwards = far ? (x * vx + y * vy + (round ? 0 : z * vz)) / far / speed : 0
    const across = x * vy - y * vx
    const sideways = round ? WORDS.round[across > 0 ? 'left' : 'right'] : WORDS.way.across
    const [out, back] = round ? [WORDS.way.out, WORDS.way.in] : [WORDS.way.away, WORDS.way.back]
    said.push(outwards > MOSTLY ? out : outwards < -MOSTLY ? back : far ? sideways : out)
    const near = Math.max(1, Math.round(times.length / 50))
    const gain = (speeds[Math.min(at + near, times.length - 1)] ?? 0) - (speeds[Math.max(at - near, 0)] ?? 0)
    said.push(gain > CHANGES * most ? WORDS.pace.faster : gain < -CHANGES * most ? WORDS.pace.slower : WORDS.pace.even)
  }
  const phase = WORDS.phase[columns.phase?.[at] ?? 0]
  if (phase) said.push(phase)
  return said.map((one) => t(one)).join(', ')
}

/** The same of all that move, with the time. */
export function narrated(scenes: readonly Scene[], time: number): string {
  const one = (scene: Scene) => {
    const { label, noun = WORDS.body } = scene.header.body
    const called = scenes.length > 1 ? label : noun
    return `${t(called)} ${described(scene, time)}`
  }
  return scenes.length ? WORDS.at(time.toFixed(1), scenes.map(one).join('; ')) : ''
}

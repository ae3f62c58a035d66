/**
 * What a course shows, in one sentence: as `trundle.views.scene.headline` has it for a run.
 *
 * The number comes from the samples; beside it stands what theory says, where the page holds the formula, or the same
 * number by another way through the samples.
 */
import type { Headline } from '../viewer/scene'
import type { Course } from './course'
import type { Law, Shows } from './law'

type Told = { said: string; unit: string; measured: number; other: number | null; how: string }
type Signal = number[]
type V = [number, number, number]

const NOTHING = 1e-12
const CLEAR = 0.5 // cosine or share from which a direction is plain
const SEEN = 0.2 // of the first spin, from which it counts as spin the other way
const LEAST_ROUNDS = 2
const EVEN = 0.03
const NODS = 0.3 // degrees
const UNTOLD = 0.25 // turns between two samples by which two ways of counting part
const CUT_OFF = 0.01 // share of a path that its chords may cut off
const MOVES = 1e-3 // of the body's own size
const BY_TURNING = 'by the orientation; and by the integral of the angular velocity'
const OF_EVENTS = 'by the event; and by the samples before it, drawn on'
const PERIOD = 'by how often it passes its middle; and by its peaks'
const THEORY = 'by its closed form; and from the samples'

export function headlineOf(course: Course, { shows, begin }: Law): Headline | null {
  if (course.time.length < 4) return null
  const seen = new Seen(course, shows, begin)
  const promised = FINDS[shows.said]?.(seen, shows.said)
  const found = promised || SEEN_FIRST.map((look) => look(seen)).find((one) => one !== null)
  if (!found) return null
  const theory = found === promised && course.promised !== null
  const told = theory ? { ...found, other: Math.abs(course.promised!), how: THEORY } : found
  return inWords(told, theory, shows.units)
}

function inWords({ said, unit, measured, other, how }: Told, predicted: boolean, units: Shows['units']): Headline {
  const [scale, symbol] = unitFor(Math.abs(measured) < NOTHING ? 1 : Math.abs(measured), unit, units)
  const word = (value: number) => {
    const digits = String(Number((Math.abs(value) < NOTHING ? 0 : value / scale).toPrecision(4))).replace('-', '−')
    return symbol === '' || symbol === '°' ? digits + symbol : `${digits} ${symbol}`
  }
  const known = other !== null && Number.isFinite(other)
  return { said, unit, text: said.replace('{}', word(measured)), other: known ? word(other) : null, predicted, how }
}

function unitFor(size: number, unit: string, units: Shows['units']): [number, string] {
  const fit = units[unit]?.find(([scale, , least]) => size >= least * scale * (1 - 1e-9))
  return fit ? [fit[0], fit[1]] : [1, unit]
}

/** The samples of a course, by name. */
class Seen {
  readonly time: Signal
  readonly up: V
  readonly radius: number
  private readonly kept = new Map<string, Signal>()

  constructor(
    readonly course: Course,
    readonly shows: Shows,
    begin: number,
  ) {
    const tilt = this.parameter('support.tilt') ?? 0
    this.time = course.time.map((t) => t - begin)
    this.up = [-Math.sin(tilt), 0, Math.cos(tilt)]
    this.radius = Math.hypot(...sub(this.vector('contact', 0), this.vector('position', 0)))
  }

  /** A number of the system, if it has one of this name. */
  parameter(name: string): number | undefined {
    return this.course.parameters[this.shows.parameters.indexOf(name)]
  }

  get count(): number {
    return this.time.length
  }

  get duration(): number {
    return this.time[this.count - 1]!
  }

  column(name: string): Signal {
    const known = this.kept.get(name)
    if (known) return known
    const index = this.shows.row.indexOf(name)
    const found = this.course.rows.map((row) => row[index] ?? Number.NaN)
    this.kept.set(name, found)
    return found
  }

  vector(name: string, i: number): V {
    return ['x', 'y', 'z'].map((axis) => this.column(`${name}_${axis}`)[i]!) as V
  }

  vectors(name: string): V[] {
    return this.time.map((_, i) => this.vector(name, i))
  }

  speeds(): Signal {
    return this.vectors('velocity').map((v) => Math.hypot(...v))
  }

  /** One of the body's axes at each sample: its first, or its third. */
  axis(which: 0 | 2): V[] {
    const [w, x, y, z] = ['w', 'x', 'y', 'z'].map((part) => this.column(`orientation_${part}`)) as [
      Signal,
      Signal,
      Signal,
      Signal,
    ]
    return this.time.map((_, i) => {
      const [a, b, c, d] = [w[i]!, x[i]!, y[i]!, z[i]!]
      if (which === 2) return [2 * (b * d + a * c), 2 * (c * d - a * b), 1 - 2 * (b * b + c * c)]
      return [1 - 2 * (c * c + d * d), 2 * (b * c + a * d), 2 * (b * d - a * c)]
    })
  }

  since({ time }: { time: number }): number {
    return time - this.course.time[0]!
  }

  /** The first samples, up to the first event that does not end the motion. */
  before(): number {
    const first = this.course.events.find((event) => event !== this.course.ended)
    if (!first) return this.count
    const index = this.course.time.findIndex((t) => t >= first.time)
    return index < 0 ? this.count : index
  }
}

const SEEN_FIRST: ((seen: Seen) => Told | null)[] = [
  inversion,
  reversal,
  eventTold,
  (seen) => (rounds(seen)?.unit ? rounds(seen) : null),
  oscillation,
  rounds,
  way,
]

// --- spin and axis

function inversion(seen: Seen): Told | null {
  if (seen.shows.ball) return null
  const { up, time } = seen
  const axis = seen.axis(2)
  const height = axis.map((one) => dot(one, up))
  const [first, last] = [height[0]!, height[height.length - 1]!]
  if (Math.min(Math.abs(first), Math.abs(last)) < CLEAR || first * last > 0) return null
  const rate = seen.vectors('angular_velocity').map((turning, i) => dot(cross(turning, axis[i]!), up))
  const at = crossings(time, height).at(-1)
  const other = crossings(
    time,
    integral(time, rate).map((one) => first + one),
  ).at(-1)
  if (at === undefined) return null
  const how = 'where its axis passes the horizontal: by its orientation; and by the integral of its angular velocity'
  return { said: 'turns upside down after {}', unit: 's', measured: at, other: other ?? null, how }
}

function reversal(seen: Seen): Told | null {
  if (seen.shows.ball) return null
  const { up, time } = seen
  const turning = seen.vectors('angular_velocity')
  const spin = turning.map((one) => dot(one, up))
  const first = spin[0]!
  if (Math.abs(first) < CLEAR * Math.max(Math.hypot(...turning[0]!), 1e-300)) return null
  const end = spin.findIndex((one) => one / first < -SEEN)
  if (end < 0) return null
  let begin = end
  while (begin > 0 && spin[begin]! / first <= SEEN) begin--
  const level = (axis: V[]) => Math.max(...axis.map((one) => Math.abs(dot(one, up))))
  const [one, third] = [seen.axis(0), seen.axis(2)]
  const ways = headings(seen, level(one) < level(third) ? one : third)
  const part = (values: Signal) => values.slice(begin, end + 1)
  const tops = ways.map((angle) =>
    peak(
      part(time),
      part(angle).map((value) => value * first),
    ),
  )
  const how = `where the heading turns back: ${BY_TURNING}`
  return { said: 'reverses its spin after {}', unit: 's', measured: tops[0]!, other: tops[1]!, how }
}

function rounds(seen: Seen): Told | null {
  if (seen.shows.ball) return null
  const axis = seen.axis(2)
  const { time, duration } = seen
  if (axis.map((one) => degrees(one, seen.up)).some((lean) => lean <= NODS || lean >= 180 - NODS)) return null
  const ways = headings(seen, axis).map((way) => way.map((angle) => (angle - way[0]!) / (2 * Math.PI)))
  const parted = ways[0]!.map((angle, i) => angle - ways[1]![i]!)
  if (parted.some((one, i) => i > 0 && Math.abs(one - parted[i - 1]!) > UNTOLD)) return null
  const [first, other] = ways.map((way) => Math.abs(way[way.length - 1]!)) as [number, number]
  if (first < LEAST_ROUNDS) return null
  const whole = ways[0]![ways[0]!.length - 1]!
  const uneven = spread(ways[0]!.map((value, i) => value - (whole * time[i]!) / duration))
  if (uneven < EVEN)
    return {
      said: 'goes round every {}',
      unit: 's',
      measured: duration / first,
      other: duration / other,
      how: BY_TURNING,
    }
  const said = `its axis goes round {} times in ${Number(duration.toPrecision(4))} s`
  return { said, unit: '', measured: first, other, how: BY_TURNING }
}

/** The angle of an axis of the body about the vertical: by orientation, and by the angular velocity. */
function headings(seen: Seen, axis: V[]): [Signal, Signal] {
  const { up } = seen
  const east: V = [up[2], 0, -up[0]]
  const north = cross(up, east)
  const angle = unwrapped(axis.map((one) => Math.atan2(dot(one, north), dot(one, east))))
  const turning = seen.vectors('angular_velocity')
  const rate = axis.map((one, i) => {
    const along = dot(one, up)
    const level = one.map((part, j) => part - along * up[j]!) as V
    return dot(cross(level, cross(turning[i]!, one)), up) / dot(level, level)
  })
  return [angle, integral(seen.time, rate).map((one) => one + angle[0]!)]
}

// --- events

/** What is told of each kind of event, and what falls to nothing there. */
const TOLD: Record<string, [string, ((seen: Seen) => Signal) | null]> = {
  lift: ['leaves the support after {}', (seen) => seen.column('normal')],
  slip: ['begins to slip after {}', frictionLeft],
  grip: ['slips for {}, then rolls', (seen) => seen.column('slip')],
  stop: ['comes to rest after {}', (seen) => seen.speeds()],
  rim: ['runs off the rim after {}', toTheRim],
  end: ['reaches the end of the surface after {}', null],
  edge: ['goes over its edge after {}', null],
  spot: ['stops rolling after {}', (seen) => seen.speeds()],
}

function frictionLeft(seen: Seen): Signal {
  const [normal, share] = [seen.column('normal'), seen.column('friction')]
  return normal.map((N, i) => N * ((seen.parameter('support.friction') ?? 0) - share[i]!))
}

function toTheRim(seen: Seen): Signal {
  const rim = seen.parameter('support.rim') ?? 0
  return seen.vectors('contact').map((p, i) => {
    const off = sub(p, seen.vector('support_position', i))
    const along = (column: string) => {
      const axis = ['x', 'y', 'z'].map((row) => seen.column(`support_rotation_${row}${column}`)[i]!) as V
      return dot(axis, off)
    }
    return rim - Math.hypot(along('x'), along('y'))
  })
}

function eventTold(seen: Seen): Told | null {
  const event = seen.course.events.find(({ kind }) => kind in TOLD)
  if (!event) return null
  const [said, quantity] = TOLD[event.kind]!
  const measured = seen.since(event)
  const other = quantity && drawnOn(seen, measured, quantity(seen))
  return { said, unit: 's', measured, other, how: OF_EVENTS }
}

/** When a quantity falls to nothing, by a parabola through its last values before an event. */
function drawnOn(seen: Seen, event: number, values: Signal): number | null {
  const { time, course } = seen
  let last = time.length - 1
  while (last >= 0 && !(time[last]! < event)) last--
  const picked: number[] = []
  // As evenly and as wide as a picture's frames: neighbours may lie as near as rounding.
  const step = seen.duration / 600
  for (let i = last; i >= 0 && picked.length < 4 && course.phase[i] === course.phase[last]; i--)
    if (!picked.length || time[picked[0]!]! - time[i]! >= 0.5 * step) picked.unshift(i)
  if (picked.length < 4) return null
  const [a, b, c] = parabola(
    picked.map((i) => time[i]! - event),
    picked.map((i) => values[i]!),
  )
  const reach = 2 * (time[picked[3]!]! - time[picked[2]!]!)
  const square = Math.max(0, b * b - 4 * a * c)
  const both = a === 0 ? [-c / b] : [(-b + Math.sqrt(square)) / (2 * a), (-b - Math.sqrt(square)) / (2 * a)]
  const near = both.filter((root) => Math.abs(root) <= reach).sort((x, y) => Math.abs(x) - Math.abs(y))
  return near.length ? event + near[0]! : null
}

// --- what comes again

function oscillation(seen: Seen): Told | null {
  const { up } = seen
  const out: [string, Signal, number] = [
    'swings out and in every {}',
    seen.vectors('position').map(([x, y]) => Math.hypot(x, y)),
    MOVES * seen.radius,
  ]
  const high: [string, Signal, number] = [
    'rises and falls every {}',
    seen.vectors('position').map((one) => dot(one, up)),
    MOVES * seen.radius,
  ]
  const nods = (): [string, Signal, number] => ['nods every {}', seen.axis(2).map((one) => degrees(one, up)), NODS]
  for (const [said, values, needed] of seen.shows.ball ? [out, high] : [nods(), high, out]) {
    if (spread(values) < needed) continue
    const found = again(seen.time, values)
    if (found) return { said, unit: 's', ...found, how: PERIOD }
  }
  return null
}

/** The period of what goes to and fro evenly: by its middle and by its peaks. */
function again(time: Signal, values: Signal): { measured: number; other: number } | null {
  const middle = 0.5 * (Math.max(...ends(values)) + Math.min(...ends(values)))
  const rising = crossings(
    time,
    values.map((value) => value - middle),
    true,
  )
  const tops: Signal = []
  for (let i = 1; i + 1 < values.length; i++)
    if (values[i]! > middle && values[i]! > values[i - 1]! && values[i]! >= values[i + 1]!)
      tops.push(peak(time.slice(i - 1, i + 2), values.slice(i - 1, i + 2)))
  const even = (times: Signal) => {
    const steps = times.slice(1).map((t, i) => t - times[i]!)
    return spread(steps) <= (EVEN * steps.reduce((a, b) => a + b, 0)) / steps.length
  }
  if (rising.length < 3 || tops.length < 2 || !even(rising) || !even(tops)) return null
  const mean = (times: Signal) => (times[times.length - 1]! - times[0]!) / (times.length - 1)
  return { measured: mean(rising), other: mean(tops) }
}

function way(seen: Seen): Told | null {
  const chords = pathOf(seen)
  if (!chords || cutOff(seen) > CUT_OFF * chords) return null
  const other = integral(seen.time, seen.speeds()).at(-1)!
  const said = `goes {} in ${Number(seen.duration.toPrecision(4))} s`
  const how = 'along its path: from sample to sample; and by the integral of its speed'
  return { said, unit: 'm', measured: chords, other, how }
}

function pathOf(seen: Seen): number {
  const places = seen.vectors('position')
  return places.slice(1).reduce((sum, p, i) => sum + Math.hypot(...sub(p, places[i]!)), 0)
}

/** By how much the chords from sample to sample are too short: of an arc that turns by θ by the share θ²/24. */
function cutOff(seen: Seen): number {
  const [places, ways] = [seen.vectors('position'), seen.vectors('velocity')]
  return places.slice(1).reduce((sum, p, i) => {
    const turned = Math.atan2(Math.hypot(...cross(ways[i]!, ways[i + 1]!)), dot(ways[i]!, ways[i + 1]!))
    return sum + (Math.hypot(...sub(p, places[i]!)) * turned ** 2) / 24
  }, 0)
}

// --- what theory has a sentence for, measured in the samples

type Finds = (seen: Seen, said: string) => Told | null

/** By the sentence; the number beside it is theory's, where the page holds the formula. */
const FINDS: Record<string, Finds> = {
  'stays, to within {}': (seen, said) => {
    const places = seen.vectors('position')
    const measured = Math.max(...places.map((p) => Math.hypot(...sub(p, places[0]!))))
    return { said, unit: 'm', measured, other: null, how: '' }
  },
  'rolls straight at {}': (seen, said) => {
    const gone = Math.hypot(...sub(seen.vector('position', seen.count - 1), seen.vector('position', 0)))
    return { said, unit: 'm/s', measured: gone / seen.duration, other: pathOf(seen) / seen.duration, how: '' }
  },
  'accelerates at {}': accelerates,
  'slips, accelerating at {}': accelerates,
  "circles at {} of the table's rate": (seen, said) => {
    const rate = circling(seen)
    const table = unwrapped(
      seen.time.map((_, i) =>
        Math.atan2(seen.column('support_rotation_yx')[i]!, seen.column('support_rotation_xx')[i]!),
      ),
    )
    const turned = (table[table.length - 1]! - table[0]!) / seen.duration
    return rate === null ? null : { said, unit: '', measured: rate / turned, other: null, how: THEORY }
  },
  'drifts {}': drifts,
  "drifts {} along the slope's level": drifts,
  'bobs {} times a round': (seen, said) => {
    const places = seen.vectors('position')
    const found = again(
      seen.time,
      places.map(([, , z]) => z),
    )
    const turned = unwrapped(places.map(([x, y]) => Math.atan2(y, x)))
    const round = Math.abs(turned[turned.length - 1]! - turned[0]!) / (2 * Math.PI * seen.duration)
    return (
      found && { said, unit: '', measured: 1 / found.measured / round, other: 1 / found.other / round, how: PERIOD }
    )
  },
  'swings to and fro in {}': (seen, said) => {
    const places = seen.vectors('position')
    const sides = [0, 1, 2].map((axis) => places.map((p) => p[axis]!))
    const widest = sides.reduce((best, one) => (spread(one) > spread(best) ? one : best))
    const found = again(seen.time, widest)
    return found && { said, unit: 's', ...found, how: PERIOD }
  },
  'goes round in {}': (seen, said) => {
    const arms = seen.vectors('contact').map((p, i) => sub(p, seen.vector('position', i)))
    let turned = 0
    const angle = arms.map((arm, i) => {
      if (i) turned += Math.atan2(Math.hypot(...cross(arms[i - 1]!, arm)), dot(arms[i - 1]!, arm))
      return turned
    })
    const whole = Math.floor(turned / (2 * Math.PI))
    const at = crossings(
      seen.time,
      angle.map((one) => one - 2 * Math.PI * whole),
    )[0]
    return whole < 1 || at === undefined ? null : { said, unit: 's', measured: at / whole, other: null, how: '' }
  },
  'rounds its ellipse in {}': (seen, said) => {
    const found = again(seen.time, seen.column('position_x'))
    return found && { said, unit: 's', ...found, how: PERIOD }
  },
  'turns faster every {}': (seen, said) => {
    const found = again(
      seen.time,
      seen.vectors('angular_velocity').map((one) => Math.hypot(...one)),
    )
    return found && { said, unit: 's', ...found, how: PERIOD }
  },
  'comes off {} from the top': (seen, said) => fromTheTop(seen, said, 'lift'),
  'begins to slip {} from the top': (seen, said) => fromTheTop(seen, said, 'slip'),
  'lands after {}': (seen, said) => {
    const event = seen.course.events.find(({ kind }) => kind === 'land')
    if (!event) return null
    const height = seen.vectors('position').map((p) => dot(p, seen.up))
    const lands = height[seen.course.time.findIndex((t) => t >= event.time)]!
    const over = height.map((one) => one - lands)
    const measured = seen.since(event)
    return { said, unit: 's', measured, other: drawnOn(seen, measured, over), how: OF_EVENTS }
  },
}

function accelerates(seen: Seen, said: string): Told {
  const last = seen.before() - 1
  const [v, r] = [seen.vector('velocity', last), seen.vector('position', last)]
  const [v0, r0, t] = [seen.vector('velocity', 0), seen.vector('position', 0), seen.time[last]!]
  const way = sub(r, r0).map((part, i) => (2 * (part - v0[i]! * t)) / (t * t)) as V
  const how = 'by its velocity; and by its way'
  return { said, unit: 'm/s²', measured: Math.hypot(...sub(v, v0)) / t, other: Math.hypot(...way), how }
}

/** At which rate a velocity goes round that may drift: by the direction in which it changes. */
function circling(seen: Seen): number | null {
  const last = seen.before()
  const v = seen.vectors('velocity').slice(0, last)
  const chords = v.slice(1).map((one, i) => sub(one, v[i]!))
  if (chords.length < 2 || chords.every((one) => Math.hypot(one[0], one[1]) === 0)) return null
  const angle = unwrapped(chords.map(([x, y]) => Math.atan2(y, x)))
  const middle = (i: number) => 0.5 * (seen.time[i]! + seen.time[i + 1]!)
  const end = chords.length - 1
  return (angle[end]! - angle[0]!) / (middle(end) - middle(0))
}

function drifts(seen: Seen, said: string): Told | null {
  const [last, rate] = [seen.before() - 1, circling(seen)]
  const [r, r0] = [seen.vector('position', last), seen.vector('position', 0)]
  const [v, v0, t] = [seen.vector('velocity', last), seen.vector('velocity', 0), seen.time[last]!]
  const straight = Math.hypot(...sub(v, v0)) <= 1e-9 * Math.hypot(...v0) || rate === null
  // What goes round by κ moves by (V − V₀)/(iκ): the rest of the way is the drift.
  const [x, y] = straight ? [0, 0] : [(v[1] - v0[1]) / rate, -(v[0] - v0[0]) / rate]
  return { said, unit: 'm/s', measured: Math.hypot(r[0] - r0[0] - x, r[1] - r0[1] - y) / t, other: null, how: THEORY }
}

function fromTheTop(seen: Seen, said: string, kind: string): Told | null {
  const event = seen.course.events.find((one) => one.kind === kind)
  if (!event) return null
  const index = seen.course.time.findIndex((t) => t >= event.time)
  const off = sub(seen.vector('position', index), seen.vector('contact', index))
  const from = degrees(off, seen.up)
  return { said, unit: '°', measured: seen.shows.deep ? 180 - from : from, other: null, how: OF_EVENTS }
}

// --- of signals

function integral(time: Signal, rate: Signal): Signal {
  let sum = 0
  return rate.map((value, i) => {
    if (i) sum += 0.5 * (value + rate[i - 1]!) * (time[i]! - time[i - 1]!)
    return sum
  })
}

function crossings(time: Signal, values: Signal, rising = false): Signal {
  const found: Signal = []
  for (let i = 0; i + 1 < values.length; i++) {
    const [a, b] = [values[i]!, values[i + 1]!]
    if (a >= 0 === b >= 0 || (rising && b < a)) continue
    found.push(time[i]! + (a / (a - b)) * (time[i + 1]! - time[i]!))
  }
  return found
}

/** When values are largest, by the parabola through the three samples about the top. */
function peak(time: Signal, values: Signal): number {
  const top = values.reduce((best, value, i) => (value > values[best]! ? i : best), 0)
  if (top === 0 || top === values.length - 1) return time[top]!
  const around = [top - 1, top, top + 1]
  const [a, b] = parabola(
    around.map((i) => time[i]! - time[top]!),
    around.map((i) => values[i]! - values[top]!),
  )
  return a >= 0 ? time[top]! : time[top]! - b / (2 * a)
}

/** The coefficients of a parabola through points, nearest in the mean of the squares. */
function parabola(x: Signal, y: Signal): V {
  const size = Math.max(...x.map(Math.abs)) || 1
  const rows = x.map((one) => [(one / size) ** 2, one / size, 1])
  const normal = [0, 1, 2].map((j) => [
    ...[0, 1, 2].map((k) => rows.reduce((sum, row) => sum + row[j]! * row[k]!, 0)),
    rows.reduce((sum, row, i) => sum + row[j]! * y[i]!, 0),
  ])
  for (let j = 0; j < 3; j++)
    for (let k = j + 1; k < 3; k++) {
      const share = normal[k]![j]! / normal[j]![j]!
      for (let l = j; l < 4; l++) normal[k]![l]! -= share * normal[j]![l]!
    }
  const found: V = [0, 0, 0]
  for (let j = 2; j >= 0; j--) {
    const rest = found.slice(j + 1).reduce((sum, value, k) => sum + value * normal[j]![j + 1 + k]!, 0)
    found[j] = (normal[j]![3]! - rest) / normal[j]![j]!
  }
  return [found[0] / size ** 2, found[1] / size, found[2]]
}

function unwrapped(angles: Signal): Signal {
  let turns = 0
  return angles.map((angle, i) => {
    if (i) turns -= Math.round((angle - angles[i - 1]!) / (2 * Math.PI))
    return angle + 2 * Math.PI * turns
  })
}

/** The least and the most. */
function ends(values: Signal): [number, number] {
  return values.reduce<[number, number]>(
    ([low, high], v) => [Math.min(low, v), Math.max(high, v)],
    [Infinity, -Infinity],
  )
}

function spread(values: Signal): number {
  const [low, high] = ends(values)
  return high - low
}

function degrees(one: V, other: V): number {
  return (Math.atan2(Math.hypot(...cross(one, other)), dot(one, other)) * 180) / Math.PI
}

const dot = (a: V, b: V) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
const sub = (a: V, b: V): V => [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
const cross = (a: V, b: V): V => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]

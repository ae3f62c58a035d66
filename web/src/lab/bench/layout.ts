/** Which controls a scenario has, in words only: sections of fields, choices, switches. */
import { parse } from '../quantity'
import type { Json, Path, Scenario, Table } from '../scenario'
import { withValue, withValues } from '../scenario'
import type { Entry } from './catalogue'
import { component, entry, keysOf, loadEntry } from './catalogue'
import { ANGULAR, BODIES, LOADS, MOTIONS, ROUND, SURFACES, withBody, withMotion, withSurface } from './defaults'

export type Item =
  | {
      type: 'field'
      path: Path
      entry: Entry
      fallback?: Json
      /** Where it stands in the scenario, if the path is only its name here. */
      place?: Path
      set?: (scenario: Scenario, value: Json) => Scenario
    }
  | { type: 'text'; path: Path; label: string; hint?: string }
  | {
      type: 'choice'
      path: Path
      label: string
      value: string
      options: [string, string][]
      set: (scenario: Scenario, value: string) => Scenario
    }
  | {
      type: 'switch'
      path: Path
      label: string
      on: boolean
      hint?: string
      set: (scenario: Scenario, on: boolean) => Scenario
    }
  | { type: 'remove'; path: Path; label: string; set: (scenario: Scenario) => Scenario }
  | {
      type: 'add'
      path: Path
      label: string
      options: [string, string][]
      set: (scenario: Scenario, kind: string) => Scenario
    }

export interface Section {
  id: string
  title: string
  items: Item[]
  /** Folded away at first. */
  folded?: boolean
}

type Kinds = Record<string, { label: string }>

/** The kinds on offer, and the scenario's own where it is not among them. */
function offered(kinds: Kinds, own: string): [string, string][] {
  const all = Object.entries(kinds).map(([kind, { label }]): [string, string] => [kind, label])
  return own in kinds ? all : [[own, own.replaceAll('-', ' ')], ...all]
}

function field(path: Path, of: Entry | undefined, fallback?: Json): Item[] {
  if (!of) return []
  return [{ type: 'field', path, entry: of, ...(fallback !== undefined && { fallback }) }]
}

/** The numbers that a table says, in the catalogue's order. */
function present(table: string, values: Table, except: string[] = []): Item[] {
  const numbers = keysOf(table).filter((key) => key in values && !except.includes(key) && !Array.isArray(values[key]))
  const vectors = Object.keys(values).filter((key) => Array.isArray(values[key]) && !except.includes(key))
  return [
    ...numbers.flatMap((key) => field(`${table}.${key}`, entry(table, key))),
    ...vectors.flatMap((key) => vector(`${table}.${key}`, values[key] as Json[])),
  ]
}

function vector(path: Path, values: Json[], known = path): Item[] {
  return values.flatMap((_, index) => field(`${path}.${index}`, component(known, index)))
}

function formula(table: string, values: Table, label: string): Item[] {
  return typeof values.formula === 'string' ? [{ type: 'text', path: `${table}.formula`, label }] : []
}

function bodySection(scenario: Scenario): Section {
  const { body } = scenario
  const items: Item[] = []
  if (body.kind)
    items.push({
      type: 'choice',
      path: 'body.kind',
      label: 'Shape',
      value: body.kind,
      options: offered(BODIES, body.kind),
      set: withBody,
    })
  const ratio: Record<string, number> = { 'solid-sphere': 0.4, 'hollow-sphere': 2 / 3 }
  if (ROUND.has(body.kind) && body.kind !== 'sphere-with-moment' && body.density === undefined) {
    const of = entry('body', 'inertia_ratio') as Entry
    const fallback = ratio[body.kind]
    const set = (now: Scenario, value: Json) =>
      withValues(now, [
        ['body.kind', 'sphere'],
        ['body.inertia_ratio', value],
      ])
    items.push({
      type: 'field',
      path: 'body.inertia_ratio',
      entry: of,
      set,
      ...(fallback !== undefined && { fallback }),
    })
  }
  const kind = body.kind
  items.push(...present('body', body, ROUND.has(kind) ? ['inertia_ratio'] : []))
  if (typeof body.support_function === 'string')
    items.push({ type: 'text', path: 'body.support_function', label: 'Support function' })
  return { id: 'body', title: 'Body', items }
}

const LANDING = ['kinetic_friction', 'restitution', 'tangential_restitution']

function supportSection(scenario: Scenario): Section {
  const { support } = scenario
  const optional = (key: string, label: string, value: Json, hint: string): Item => ({
    type: 'switch',
    path: `support.${key}.on`,
    label,
    on: support[key] !== undefined,
    hint,
    set: (now, on) => withValue(now, `support.${key}`, on ? value : undefined),
  })
  const slips = support.friction !== undefined
  const items: Item[] = [
    {
      type: 'choice',
      path: 'support.kind',
      label: 'Surface',
      value: support.kind,
      options: offered(SURFACES, support.kind),
      set: withSurface,
    },
    ...field('support.tilt', entry('support', 'tilt'), '0 deg'),
    ...present('support', support, ['tilt', 'rim', 'friction', ...LANDING, 'r', 'x', 'y', 'z']),
    ...formula('support', support, 'Height, in m'),
    optional('rim', 'Has a rim', '50 cm', 'without one it has no end'),
    ...(support.rim !== undefined ? field('support.rim', entry('support', 'rim')) : []),
    optional('friction', 'Friction is limited', 0.3, 'otherwise it grips as much as it takes'),
    ...(slips ? field('support.friction', entry('support', 'friction')) : []),
    ...(slips ? field('support.kinetic_friction', entry('support', 'kinetic_friction'), support.friction as Json) : []),
    ...(slips ? field('support.restitution', entry('support', 'restitution'), 0) : []),
    ...(slips ? field('support.tangential_restitution', entry('support', 'tangential_restitution'), 0) : []),
  ]
  return { id: 'support', title: 'Support', items }
}

function motionSection(scenario: Scenario): Section {
  const motion: Table & { kind: string } = scenario.support.motion ?? { kind: 'fixed' }
  const items: Item[] = [
    {
      type: 'choice',
      path: 'support.motion.kind',
      label: 'Kind',
      value: motion.kind,
      options: offered(MOTIONS, motion.kind),
      set: withMotion,
    },
    ...present('support.motion', motion),
  ]
  return { id: 'motion', title: 'Motion of the support', items }
}

/** How a place on this surface is said: by x and y, or by angles. */
function positionEntries(kind: string, reach: number): [Entry, Entry] {
  const along = (label: string): Entry => ({ label, kind: 'length', min: -reach, max: reach })
  const angle = (label: string): Entry => ({ label, kind: 'angle', min: -Math.PI, max: Math.PI, units: ['deg', 'rad'] })
  if (kind === 'torus-track') return [angle('Angle about the axis'), angle('Angle around the tube')]
  if (ANGULAR.has(kind)) return [angle('Angle about the axis'), along('Height along the axis')]
  return [along('Position x'), along('Position y')]
}

function startSection(scenario: Scenario, reach: number): Section {
  const { start, support } = scenario
  const [first, second] = positionEntries(support.kind, reach)
  const rides = start.velocity === 'co-rotating'
  const moves = support.motion !== undefined && support.motion.kind !== 'fixed'
  const items: Item[] = [...field('start.position.0', first, 0), ...field('start.position.1', second, 0)]
  if (moves || rides)
    items.push({
      type: 'switch',
      path: 'start.velocity.on',
      label: 'Rides along with the support',
      on: rides,
      hint: 'and is let go',
      set: (now, on) => withValue(now, 'start.velocity', on ? 'co-rotating' : ['0 m/s', '0 m/s']),
    })
  if (!rides) {
    const length = Array.isArray(start.velocity) ? start.velocity.length : 2
    for (let index = 0; index < length; index += 1) items.push(...velocity(index))
  }
  const turning = Array.isArray(start.angular_velocity)
  if (turning) items.push(...vector('start.angular_velocity', start.angular_velocity as Json[]))
  else items.push(...field('start.spin', entry('start', 'spin'), rides ? undefined : 0))
  if (support.friction !== undefined || start.height !== undefined)
    items.push(...field('start.height', entry('start', 'height'), 0))
  items.push(...present('start', start, ['position', 'velocity', 'angular_velocity', 'spin', 'height']))
  return { id: 'start', title: 'Start', items }
}

/** A velocity that is not there yet is written as a pair. */
function velocity(index: number): Item[] {
  const of = component('start.velocity', index)
  if (!of) return []
  const set = (now: Scenario, value: Json) => {
    const known = Array.isArray(now.start.velocity) ? now.start.velocity : ['0 m/s', '0 m/s']
    return withValue(
      now,
      'start.velocity',
      known.map((was, place) => (place === index ? value : was)),
    )
  }
  return [{ type: 'field', path: `start.velocity.${index}`, entry: of, fallback: '0 m/s', set }]
}

/** The drag that has its own slider. */
function mainDrag(loads: (Table & { kind: string })[]): number {
  return loads.findIndex((load) => load.kind === 'drag')
}

/** Drag is always on offer; at nought there is no such load, unless it says more than a coefficient. */
function dragOf(loads: (Table & { kind: string })[]): Item {
  const at = mainDrag(loads)
  const set = (now: Scenario, value: Json) => {
    const known = now.loads ?? []
    const index = mainDrag(known)
    const none = parse(value).number === 0
    const load = { ...known[index], kind: 'drag', coefficient: value }
    const goes = none && Object.keys(load).length === 2
    const next = known.flatMap((one, place) => (place !== index ? [one] : goes ? [] : [load]))
    if (index < 0 && !none) next.push(load)
    return withValue(now, 'loads', next.length ? (next as Json) : undefined)
  }
  const of = loadEntry('drag', 'coefficient') as Entry
  const item = { type: 'field' as const, path: 'loads.drag', entry: of, fallback: '0 g/s', set }
  return at < 0 ? item : { ...item, place: `loads.${at}.coefficient` }
}

function loadsSection(scenario: Scenario): Section {
  const loads = scenario.loads ?? []
  const gravity: Entry = { label: 'Gravity', kind: 'acceleration', min: 0, max: 25 }
  const items: Item[] = [...field('gravity', gravity, 9.80665), dragOf(loads)]
  loads.forEach((load, place) => {
    if (place === mainDrag(loads)) return
    for (const [key, value] of Object.entries(load)) {
      const path = `loads.${place}.${key}`
      if (Array.isArray(value)) items.push(...vector(path, value, `${load.kind}.${key}`))
      else items.push(...field(path, loadEntry(load.kind, key)))
      if (key === 'formula') items.push({ type: 'text', path, label: 'Potential, in J' })
    }
    const label = LOADS[load.kind]?.label ?? load.kind.replaceAll('-', ' ')
    const set = (now: Scenario) => {
      const rest = (now.loads ?? []).filter((_, other) => other !== place)
      return withValue(now, 'loads', rest.length ? (rest as Json) : undefined)
    }
    items.push({ type: 'remove', path: `loads.${place}`, label: `Remove: ${label.toLowerCase()}`, set })
  })
  items.push({
    type: 'add',
    path: 'loads',
    label: 'Add a load',
    options: Object.entries(LOADS)
      .filter(([kind]) => kind !== 'drag')
      .map(([kind, { label }]) => [kind, label]),
    set: (now, kind) => withValue(now, 'loads', [...(now.loads ?? []), { kind, ...LOADS[kind]?.keys }] as Json),
  })
  return { id: 'loads', title: 'Gravity, drag, other loads', items }
}

function runSection(scenario: Scenario): Section {
  const method = typeof scenario.run.method === 'string' ? scenario.run.method : 'auto'
  const words: [string, string][] = [
    ['auto', 'the best there is'],
    ['exact', 'closed form'],
    ['taylor', 'Taylor series'],
    ['runge-kutta', 'Runge–Kutta'],
  ]
  return {
    id: 'run',
    title: 'Run',
    items: [
      ...present('run', scenario.run),
      {
        type: 'choice',
        path: 'run.method',
        label: 'Method',
        value: method,
        options: words,
        set: (now, value) => withValue(now, 'run.method', value),
      },
    ],
  }
}

const PIECE: Record<string, Entry> = {
  length: { label: 'Length', kind: 'length', min: 0, max: 0.5 },
  heading: { label: 'Heading', kind: 'angle', min: -Math.PI, max: Math.PI, units: ['deg', 'rad', 'turn'] },
  turn: { label: 'Turn of the ball', kind: 'angle', min: 0, max: 2 * Math.PI, units: ['deg', 'rad', 'turn'] },
  radius: { label: 'Radius of the arc', kind: 'length', min: 0.001, max: 0.5, decades: true },
  angle: {
    label: 'Angle of the arc',
    kind: 'angle',
    min: -2 * Math.PI,
    max: 2 * Math.PI,
    units: ['deg', 'rad', 'turn'],
  },
}

/** A ball that is rolled along a path, without forces, has pieces instead of a support and a start. */
function pathSection(scenario: Scenario): Section {
  const pieces = (scenario as unknown as { path?: Table[] }).path ?? []
  const items = pieces.flatMap((piece, place) =>
    Object.keys(PIECE)
      .filter((key) => key in piece && !Array.isArray(piece[key]))
      .flatMap((key) => field(`path.${place}.${key}`, { ...PIECE[key]!, label: `${place + 1}. ${PIECE[key]!.label}` })),
  )
  return { id: 'path', title: 'Pieces of the path', items }
}

/** All sections of a scenario; `reach` is how far the sliders of the position go, in m. */
export function layout(scenario: Scenario, reach: number): Section[] {
  if (!scenario.support) return [bodySection(scenario), pathSection(scenario)]
  return [
    bodySection(scenario),
    supportSection(scenario),
    motionSection(scenario),
    startSection(scenario, reach),
    loadsSection(scenario),
    runSection(scenario),
  ]
}

/** Which controls a scenario has, in words only: sections of fields, choices, switches. */
import type { Coordinate, Fields, Kind, NumberField, PartField, Parts, VectorField } from '../parts'
import { parse } from '../quantity'
import type { Json, Path, Scenario, Table } from '../scenario'
import { valueAt, withValue, withValues } from '../scenario'
import { withBody, withLoad, withLoads, withMotion, withPart, withSurface } from './choosing'
import type { Entry } from './field'

/** What may be chosen: its word, its name, and a sentence about it. */
export type Option = [value: string, label: string, said?: string]

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
      options: Option[]
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
  | { type: 'add'; path: Path; label: string; options: Option[]; set: (scenario: Scenario, kind: string) => Scenario }

export interface Section {
  id: string
  title: string
  items: Item[]
  /** Folded away at first. */
  folded?: boolean
}

type Loads = NonNullable<Scenario['loads']>

/** The kinds on offer, and the scenario's own where it is not among them. */
function offered(kinds: Record<string, Kind>, own?: string): Option[] {
  const ready = Object.entries(kinds).filter(([kind, { first }]) => first !== null || kind === own)
  return ready.map(([kind, { label, said }]) => [kind, label, said])
}

/** What makes controls of the fields of tables. */
function createMaker(scenario: Scenario, parts: Parts) {
  function entry(of: NumberField | VectorField, name?: string): Entry {
    const { unit, min, max, decades, said } = of
    const label = name === undefined ? of.label : `${of.label} ${name}`
    return { label, units: parts.units[of.dimension] ?? {}, unit, min, max, decades, ...(said && { hint: said }) }
  }

  function number(path: Path, of: PartField | undefined, fallback?: Json): Item[] {
    if (of?.type !== 'number') return []
    return [{ type: 'field', path, entry: entry(of), ...(fallback !== undefined && { fallback }) }]
  }

  /** The parts of a vector, so many as there are; one that is not there yet is written whole. */
  function vector(path: Path, of: PartField | undefined, otherwise: Json[] = []): Item[] {
    if (of?.type !== 'vector') return []
    const known = valueAt(scenario, path)
    const values = Array.isArray(known) ? known : otherwise
    return values.map((_, index) => ({
      type: 'field',
      path: `${path}.${index}`,
      entry: entry(of, of.names[index] ?? String(index + 1)),
      ...(otherwise[index] !== undefined && { fallback: otherwise[index] }),
      set: (now, value) => withValue(now, path, withPart(valueAt(now, path), otherwise, index, value)),
    }))
  }

  function choice(path: Path, { label, words, default: usual }: PartField & { type: 'choice' }): Item {
    const value = String(valueAt(scenario, path) ?? usual ?? words[0])
    const options = words.map((word): Option => [word, word])
    return { type: 'choice', path, label, value, options, set: (now, next) => withValue(now, path, next) }
  }

  /** The controls of a table: of what it says, and, where `all`, of the numbers and words that it might say. */
  function table(path: Path, fields: Fields, { except = [] as readonly string[], all = true } = {}): Item[] {
    return Object.entries(fields).flatMap(([key, of]): Item[] => {
      const at = `${path}.${key}`
      const value = valueAt(scenario, at)
      if (except.includes(key)) return []
      if (of.type === 'choice') return value !== undefined || all ? [choice(at, of)] : []
      if (of.type === 'formula')
        return typeof value === 'string' ? [{ type: 'text', path: at, label: of.label, hint: of.said }] : []
      if (of.type === 'vector') return vector(at, of)
      const usual = all && typeof of.default === 'number' ? of.default : undefined
      return value !== undefined || usual !== undefined ? number(at, of, usual) : []
    })
  }
  return { entry, number, vector, table }
}

type Maker = ReturnType<typeof createMaker>

function bodySection(scenario: Scenario, parts: Parts, make: Maker): Section {
  const { body } = scenario
  if (!body.kind) return { id: 'body', title: 'Body', items: make.table('body', parts.common.ball) }
  const items: Item[] = [
    {
      type: 'choice',
      path: 'body.kind',
      label: 'Shape',
      value: body.kind,
      options: offered(parts.body, body.kind),
      set: (now, kind) => withBody(now, kind, parts),
    },
  ]
  const kind = parts.body[body.kind]
  const ratio =
    kind?.inertia_ratio != null && body.density === undefined ? ratioOf(kind.inertia_ratio, parts, make) : []
  const except = ratio.length ? ['inertia_ratio'] : []
  return {
    id: 'body',
    title: 'Body',
    items: [...items, ...ratio, ...make.table('body', kind?.fields ?? {}, { except })],
  }
}

/** The k of a ball: where it is moved, the ball becomes one of any k. */
function ratioOf(fallback: number, parts: Parts, make: Maker): Item[] {
  const [any, of] = Object.entries(parts.body).find(([, { ball, fields }]) => ball && 'inertia_ratio' in fields) ?? []
  const set = (now: Scenario, value: Json) =>
    withValues(now, [
      ['body.kind', any],
      ['body.inertia_ratio', value],
    ])
  return make.number('body.inertia_ratio', of?.fields.inertia_ratio, fallback).map((item) => ({ ...item, set }) as Item)
}

function supportSection(scenario: Scenario, parts: Parts, make: Maker): Section {
  const { support } = scenario
  const own = parts.support[support.kind]?.fields ?? {}
  const { friction, ...landing } = parts.common.support
  const optional = Object.keys(own).filter((key) => own[key]!.type === 'number' && own[key]!.optional)
  const turnedOn = (key: string, label: string, of: PartField | undefined, hint = of?.said): Item => ({
    type: 'switch',
    path: `support.${key}.on`,
    label,
    on: support[key] !== undefined,
    ...(hint && { hint }),
    set: (now, on) => withValue(now, `support.${key}`, on && of?.type === 'number' ? of.example : undefined),
  })
  const slips = support.friction !== undefined
  const items: Item[] = [
    {
      type: 'choice',
      path: 'support.kind',
      label: 'Surface',
      value: support.kind,
      options: offered(parts.support, support.kind),
      set: (now, kind) => withSurface(now, kind, parts),
    },
    ...make.number('support.tilt', own.tilt, 0),
    ...make.table('support', own, { except: ['tilt', ...optional] }),
    ...optional.flatMap((key) => [
      turnedOn(key, `Has a ${own[key]!.label.toLowerCase()}`, own[key]),
      ...(support[key] === undefined ? [] : make.number(`support.${key}`, own[key])),
    ]),
    turnedOn('friction', 'Friction is limited', friction, 'otherwise it grips as much as it takes'),
    ...(slips ? make.number('support.friction', friction) : []),
    ...Object.entries(slips ? landing : {}).flatMap(([key, of]) =>
      make.number(`support.${key}`, of, of.default ?? (support.friction as Json)),
    ),
  ]
  return { id: 'support', title: 'Support', items }
}

function motionSection(scenario: Scenario, parts: Parts, make: Maker): Section {
  const kind = scenario.support.motion?.kind ?? parts.at_rest
  const items: Item[] = [
    {
      type: 'choice',
      path: 'support.motion.kind',
      label: 'Kind',
      value: kind,
      options: offered(parts.motion, kind),
      set: (now, next) => withMotion(now, next, parts),
    },
    ...make.table('support.motion', parts.motion[kind]?.fields ?? {}),
  ]
  return { id: 'motion', title: 'Motion of the support', items }
}

/** How a place on this surface is said: `reach` is how far the sliders of lengths go, in m. */
function positions(coordinates: readonly Coordinate[], reach: number, parts: Parts): Item[] {
  return coordinates.map(({ label, dimension, unit }, index) => {
    const most = dimension === 'length' ? reach : Math.PI
    const entry = { label, units: parts.units[dimension] ?? {}, unit, min: -most, max: most, decades: false }
    return { type: 'field', path: `start.position.${index}`, entry, fallback: 0 }
  })
}

/** Is the start said by Ω, and the velocity what rolls with it? Where friction has a limit, a start may slip. */
function saysTurning({ start, support }: Scenario): boolean {
  if (typeof start.velocity === 'string') return start.velocity === 'rolling'
  return Array.isArray(start.angular_velocity) && support.friction === undefined && start.height === undefined
}

/** With whatever else was changed: a velocity that rolled before rolls again. A rolled path has no start to say one. */
export function rollingAgain(scenario: Scenario): Scenario {
  const given = Array.isArray(scenario.start?.velocity)
  return given && saysTurning(scenario) ? withValue(scenario, 'start.velocity', 'rolling') : scenario
}

function startSection(scenario: Scenario, reach: number, parts: Parts, make: Maker): Section {
  const { start, support } = scenario
  const fields = parts.common.start
  const rides = start.velocity === 'co-rotating'
  const turns = saysTurning(scenario)
  const moves = support.motion !== undefined && support.motion.kind !== parts.at_rest
  const items = positions(parts.support[support.kind]?.coordinates ?? [], reach, parts)
  if ((moves || rides) && !turns)
    items.push({
      type: 'switch',
      path: 'start.velocity.on',
      label: 'Rides along with the support',
      on: rides,
      hint: 'and is let go',
      set: (now, on) => withValue(now, 'start.velocity', on ? 'co-rotating' : ['0 m/s', '0 m/s']),
    })
  if (turns)
    items.push({
      type: 'switch',
      path: 'start.velocity.on',
      label: 'Rolls at the speed that goes with its angular velocity',
      on: true,
      set: (now) => {
        const given = withValue(now, 'start.velocity', ['0 m/s', '0 m/s'])
        return support.friction === undefined ? withValue(given, 'start.angular_velocity', undefined) : given
      },
    })
  if (!rides && !turns) items.push(...make.vector('start.velocity', fields.velocity, ['0 m/s', '0 m/s']))
  if (Array.isArray(start.angular_velocity))
    items.push(...make.vector('start.angular_velocity', fields.angular_velocity))
  else items.push(...make.number('start.spin', fields.spin, rides ? undefined : 0))
  if (support.friction !== undefined || start.height !== undefined)
    items.push(...make.number('start.height', fields.height, 0))
  const except = ['velocity', 'angular_velocity', 'spin', 'height']
  items.push(...make.table('start', fields, { except, all: false }))
  return { id: 'start', title: 'Start', items }
}

/** A load that is always on offer; at nought there is none, unless it says more than its first number. */
function usualLoad(kind: string, loads: Loads, parts: Parts, make: Maker): Item[] {
  const placeOf = (known: Loads) => known.findIndex((load) => load.kind === kind)
  const [key = '', of] = Object.entries(parts.loads[kind]?.fields ?? {})[0] ?? []
  const set = (now: Scenario, value: Json) => {
    const known = now.loads ?? []
    const index = placeOf(known)
    const none = parse(value).number === 0
    const load = { ...known[index], kind, [key]: value }
    const goes = none && Object.keys(load).length === 2
    const next = known.flatMap((one, place) => (place !== index ? [one] : goes ? [] : [load]))
    return withLoads(now, index < 0 && !none ? [...next, load] : next)
  }
  const at = placeOf(loads)
  const place = at < 0 ? {} : { place: `loads.${at}.${key}` }
  return make.number(`loads.${kind}`, of, 0).map((item) => ({ ...item, ...place, set }) as Item)
}

function loadsSection(scenario: Scenario, parts: Parts, make: Maker): Section {
  const loads = scenario.loads ?? []
  const usual = Object.keys(parts.loads).filter((kind) => parts.loads[kind]!.usual)
  const own = usual.map((kind) => loads.findIndex((load) => load.kind === kind))
  const items: Item[] = [
    ...make.number('gravity', parts.common.scenario.gravity, parts.common.scenario.gravity?.default),
    ...usual.flatMap((kind) => usualLoad(kind, loads, parts, make)),
  ]
  loads.forEach((load, place) => {
    const { fields = {}, label = load.kind } = parts.loads[load.kind] ?? {}
    const except = own.includes(place) ? Object.keys(fields).slice(0, 1) : []
    items.push(...make.table(`loads.${place}`, fields, { except }))
    if (own.includes(place)) return
    const set = (now: Scenario) =>
      withLoads(
        now,
        now.loads?.filter((_, other) => other !== place),
      )
    items.push({ type: 'remove', path: `loads.${place}`, label: `Remove: ${label.toLowerCase()}`, set })
  })
  const more = Object.fromEntries(Object.entries(parts.loads).filter(([kind]) => !usual.includes(kind)))
  const set = (now: Scenario, kind: string) => withLoad(now, kind, parts)
  items.push({ type: 'add', path: 'loads', label: 'Add a load', options: offered(more), set })
  return { id: 'loads', title: 'Gravity, drag, other loads', items }
}

const METHODS: Record<string, string> = {
  auto: 'the best there is',
  exact: 'closed form',
  taylor: 'Taylor series',
  'runge-kutta': 'Runge–Kutta',
}

function runSection(parts: Parts, make: Maker): Section {
  const items = make.table('run', parts.common.run).map((item): Item => {
    if (item.type !== 'choice') return item
    return { ...item, options: item.options.map(([word]): Option => [word, METHODS[word] ?? word]) }
  })
  return { id: 'run', title: 'Run', items }
}

/** A ball that is rolled along a path, without forces, has pieces instead of a support and a start. */
function pathSection(scenario: Scenario, parts: Parts, make: Maker): Section {
  const pieces = (scenario as unknown as { path?: Table[] }).path ?? []
  const items = pieces.flatMap((piece, place) =>
    make.table(`path.${place}`, parts.path[String(piece.kind)] ?? {}).map((item): Item => {
      if (item.type !== 'field') return item
      return { ...item, entry: { ...item.entry, label: `${place + 1}. ${item.entry.label}` } }
    }),
  )
  return { id: 'path', title: 'Pieces of the path', items }
}

/** All sections of a scenario; `reach` is how far the sliders of the position go, in m. */
export function layout(scenario: Scenario, reach: number, parts: Parts): Section[] {
  const make = createMaker(scenario, parts)
  if (!scenario.support) return [bodySection(scenario, parts, make), pathSection(scenario, parts, make)]
  return [
    bodySection(scenario, parts, make),
    supportSection(scenario, parts, make),
    motionSection(scenario, parts, make),
    startSection(scenario, reach, parts, make),
    loadsSection(scenario, parts, make),
    runSection(parts, make),
  ]
}

import { expect, it } from 'vitest'
import { PARTS, PEA } from '../parts.fixture'
import type { Scenario } from '../scenario'
import { type Item, layout, rollingAgain } from './layout'

type FieldItem = Extract<Item, { type: 'field' }>

function items(scenario: Scenario): Item[] {
  return layout(scenario, 1, PARTS).flatMap((section) => section.items)
}

function found<Type extends Item['type']>(scenario: Scenario, type: Type, path: string) {
  const item = items(scenario).find((one) => one.type === type && one.path === path)
  if (!item) throw new Error(`no ${type} ${path}`)
  return item as Extract<Item, { type: Type }>
}

const fieldOf = (scenario: Scenario, path: string): FieldItem => found(scenario, 'field', path)
const choose = (scenario: Scenario, path: string, value: string) => found(scenario, 'choice', path).set(scenario, value)

it('offers the kinds that it is told of, and those that take more than numbers only where they are there', () => {
  const options = (path: string, scenario = PEA) => found(scenario, 'choice', path).options
  expect(options('body.kind')[0]).toEqual(['pea', 'Pea', 'Pea, in a sentence.'])
  expect(options('support.motion.kind').map(([kind]) => kind)).toEqual(['still', 'whirl', 'reel'])
  const both = { ...PEA, support: { ...PEA.support, motion: { kind: 'both' } } }
  expect(options('support.motion.kind', both).map(([kind]) => kind)).toContain('both')
})

it('makes a ball with another k when the k of a ball that has only one is moved', () => {
  const ratio = fieldOf(PEA, 'body.inertia_ratio')
  expect(ratio.fallback).toBe(0.4)
  const next = ratio.set!(PEA, 0.55)
  expect(next.body).toEqual({ kind: 'any-pea', radius: '25 mm', mass: '510 g', inertia_ratio: 0.55 })
  expect(items(next).length).toBe(items(PEA).length)
})

it('has a usual load where it is not nought, and only then', () => {
  const wind = fieldOf(PEA, 'loads.wind')
  const next = wind.set!(PEA, '2 g/s')
  expect(next.loads).toEqual([{ kind: 'wind', strength: '2 g/s' }])
  expect(fieldOf(next, 'loads.wind').place).toBe('loads.0.strength')
  expect(items(next).length).toBe(items(PEA).length)
  const more: Scenario = { ...next, loads: [{ kind: 'pull', value: [1, 0, 0] }, ...next.loads!] }
  expect(fieldOf(more, 'loads.wind').set!(more, 0).loads).toEqual([{ kind: 'pull', value: [1, 0, 0] }])
  expect(wind.set!(next, '0 g/s')).not.toHaveProperty('loads')
})

it('adds a load and takes it away', () => {
  const next = found(PEA, 'add', 'loads').set(PEA, 'pull')
  expect(fieldOf(next, 'loads.0.value.1').entry.label).toBe('Pull y')
  expect(found(next, 'remove', 'loads.0').set(next)).toEqual(PEA)
})

it('keeps mass and radius between balls, and gives what is none its own start', () => {
  const bead = choose(PEA, 'body.kind', 'bead')
  expect(bead.body).toEqual({ kind: 'bead', radius: '25 mm', mass: '510 g' })
  expect(bead.start).toBe(PEA.start)
  const penny = choose(PEA, 'body.kind', 'penny')
  expect(penny.body.radius).toBe('12 mm')
  expect(penny.start).toMatchObject({ position: PEA.start.position, attitude: [0, '80 deg', 0] })
})

it('keeps the rate between motions that turn, and drops the motion at rest', () => {
  const faster = { ...PEA, support: { ...PEA.support, motion: { kind: 'whirl', rate: '45 rpm' } } }
  expect(choose(faster, 'support.motion.kind', 'reel').support.motion).toEqual({ kind: 'reel', speed: '45 rpm' })
  expect(choose(faster, 'support.motion.kind', 'still').support).not.toHaveProperty('motion')
})

it('puts the body on a place that the new surface has', () => {
  const hose = choose(PEA, 'support.kind', 'hose')
  expect(hose.support).toEqual({ kind: 'hose', girth: '40 cm', formula: 'x', motion: PEA.support.motion })
  expect(hose.start.position).toEqual(['30 deg', 0])
  expect(fieldOf(hose, 'start.position.0').entry).toMatchObject({ units: PARTS.units.angle, unit: 'deg' })
  expect(found(hose, 'text', 'support.formula').label).toBe('z in x and y')
  expect(choose(hose, 'support.side', 'out').support.side).toBe('out')
})

it('turns on and off what may be absent', () => {
  const rim = found(PEA, 'switch', 'support.rim.on')
  expect([rim.on, rim.hint]).toEqual([true, 'Absent: no end.'])
  expect(rim.set(PEA, false).support).not.toHaveProperty('rim')
  const rough = found(PEA, 'switch', 'support.friction.on').set(PEA, true)
  expect(rough.support.friction).toBe(0.3)
  expect(fieldOf(rough, 'support.kinetic_friction').fallback).toBe(0.3)
})

it('shows the numbers that a motion has by default', () => {
  const reels = choose(PEA, 'support.motion.kind', 'reel')
  expect(fieldOf(reels, 'support.motion.phase').fallback).toBe(0)
  expect(items(PEA).map((item) => item.path)).not.toContain('start.time')
})

it('offers a start that rides along only where the support moves', () => {
  const names = (scenario: Scenario) => items(scenario).map((item) => item.path)
  expect(names(PEA)).toContain('start.velocity.on')
  expect(names(choose(PEA, 'support.motion.kind', 'still'))).not.toContain('start.velocity.on')
})

it('lets a body whose turning is told roll on, whatever else is changed', () => {
  const start = { ...PEA.start, angular_velocity: [0, '2 rad/s', '5 rad/s'], velocity: ['0.05 m/s', 0] }
  const turning = { ...PEA, start }
  const names = items(turning).map((item) => item.path)
  expect(names).toContain('start.angular_velocity.2')
  expect(names).not.toContain('start.velocity.0')
  expect(rollingAgain(turning).start).toEqual({ ...start, velocity: 'rolling' })
  const told = found(rollingAgain(turning), 'switch', 'start.velocity.on')
  expect(told.set(rollingAgain(turning), false).start).toEqual({ ...PEA.start, velocity: ['0 m/s', '0 m/s'] })
  // What may slip, rides along or flies says both by itself.
  for (const other of [
    { support: { ...PEA.support, friction: 0.3 } },
    { start: { ...start, velocity: 'co-rotating' } },
  ])
    expect(rollingAgain({ ...turning, ...other })).toEqual({ ...turning, ...other })
  expect(rollingAgain({ ...PEA, start: { ...start, height: '1 cm' } }).start.velocity).toBe(start.velocity)
  expect(choose(rollingAgain(turning), 'body.kind', 'penny').start.velocity).not.toBe('rolling')
})

it('leaves a rolled path as it is, which has no start', () => {
  const { start: _, support: __, ...rolled } = PEA
  const path = { ...rolled, path: [{ kind: 'straight', length: '10 cm' }] } as unknown as typeof PEA
  expect(rollingAgain(path)).toBe(path)
})

it('writes a velocity that is not there yet as a pair', () => {
  const { velocity: _, ...start } = PEA.start
  const next = fieldOf({ ...PEA, start }, 'start.velocity.1').set!({ ...PEA, start }, '1 m/s')
  expect(next.start.velocity).toEqual(['0 m/s', '1 m/s'])
})

it('shows the pieces of a path, which has no support', () => {
  const path = [
    { kind: 'ahead', heading: '0 deg', turn: '90 deg' },
    { kind: 'bend', radius: '5 mm', angle: '1 turn' },
  ]
  const rolled = { body: { radius: '25 mm' }, path } as unknown as Scenario
  const fields = items(rolled).map((item) => item.path)
  expect(fields).toEqual(['body.radius', 'path.0.heading', 'path.0.turn', 'path.1.radius', 'path.1.angle'])
})

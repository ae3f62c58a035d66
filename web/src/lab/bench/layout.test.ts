import { expect, it } from 'vitest'
import { FIRST } from '../first'
import type { Scenario } from '../scenario'
import { type Item, layout } from './layout'

type FieldItem = Extract<Item, { type: 'field' }>

function items(scenario: Scenario): Item[] {
  return layout(scenario, 1).flatMap((section) => section.items)
}

function fieldOf(scenario: Scenario, path: string): FieldItem {
  const found = items(scenario).find((item) => item.type === 'field' && item.path === path)
  if (found?.type !== 'field') throw new Error(`no field ${path}`)
  return found
}

function choose(scenario: Scenario, path: string, value: string): Scenario {
  const found = items(scenario).find((item) => item.type === 'choice' && item.path === path)
  if (found?.type !== 'choice') throw new Error(`no choice ${path}`)
  return found.set(scenario, value)
}

it('makes a ball with another k when the k of a solid ball is moved', () => {
  const ratio = fieldOf(FIRST, 'body.inertia_ratio')
  expect(ratio.fallback).toBe(0.4)
  const next = ratio.set!(FIRST, 0.55)
  expect(next.body).toEqual({ kind: 'sphere', radius: '25 mm', mass: '510 g', inertia_ratio: 0.55 })
  expect(items(next).length).toBe(items(FIRST).length)
})

it('has drag as a load where it is not nought, and only then', () => {
  const drag = fieldOf(FIRST, 'loads.drag')
  const next = drag.set!(FIRST, '2 g/s')
  expect(next.loads).toEqual([{ kind: 'drag', coefficient: '2 g/s' }])
  expect(fieldOf(next, 'loads.drag').place).toBe('loads.0.coefficient')
  expect(items(next).length).toBe(items(FIRST).length)
  const more: Scenario = { ...next, loads: [{ kind: 'force', value: ['1 N', 0, 0] }, ...next.loads!] }
  expect(fieldOf(more, 'loads.drag').set!(more, 0).loads).toEqual([{ kind: 'force', value: ['1 N', 0, 0] }])
  expect(drag.set!(next, '0 g/s')).not.toHaveProperty('loads')
})

it('keeps mass and radius between balls, and gives a coin its own start', () => {
  const hollow = choose(FIRST, 'body.kind', 'hollow-sphere')
  expect(hollow.body).toEqual({ kind: 'hollow-sphere', radius: '25 mm', mass: '510 g' })
  expect(hollow.start).toBe(FIRST.start)
  const coin = choose(FIRST, 'body.kind', 'disc')
  expect(coin.body.radius).toBe('12 mm')
  expect(coin.start).toHaveProperty('attitude')
})

it('keeps the rate between motions that turn, and drops the motion at rest', () => {
  const faster = { ...FIRST, support: { ...FIRST.support, motion: { kind: 'spin', rate: '45 rpm' } } }
  expect(choose(faster, 'support.motion.kind', 'wobble').support.motion).toMatchObject({
    kind: 'wobble',
    rate: '45 rpm',
  })
  expect(choose(faster, 'support.motion.kind', 'fixed').support).not.toHaveProperty('motion')
})

it('puts the body on a place that the new surface has', () => {
  const tube = choose(FIRST, 'support.kind', 'torus-track')
  expect(tube.support).toMatchObject({ kind: 'torus-track', ring_radius: '40 cm', motion: { kind: 'spin' } })
  expect(tube.start.position).toEqual(['30 deg', 0])
  expect(fieldOf(tube, 'start.position.1').entry.kind).toBe('angle')
})

it('offers a start that rides along only where the support moves', () => {
  const names = (scenario: Scenario) => items(scenario).map((item) => item.path)
  expect(names(FIRST)).toContain('start.velocity.on')
  expect(names(choose(FIRST, 'support.motion.kind', 'fixed'))).not.toContain('start.velocity.on')
})

it('shows the pieces of a path, which has no support', () => {
  const path = [
    { kind: 'straight', heading: '0 deg', turn: '90 deg' },
    { kind: 'arc', radius: '5 mm', angle: '1 turn' },
  ]
  const rolled = { body: { radius: '25 mm' }, path } as unknown as Scenario
  const fields = items(rolled).map((item) => item.path)
  expect(fields).toEqual(['body.radius', 'path.0.heading', 'path.0.turn', 'path.1.radius', 'path.1.angle'])
})

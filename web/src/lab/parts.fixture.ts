/** Parts that no package has: what a page shows of a scenario it has from what it is told, and from nothing else. */
import type { ChoiceField, FormulaField, NumberField, Parts, VectorField } from './parts'
import type { Scenario } from './scenario'

const UNITS = {
  length: { m: 1, cm: 0.01, mm: 0.001, in: 0.0254 },
  mass: { kg: 1, g: 0.001 },
  angle: { rad: 1, deg: Math.PI / 180 },
  velocity: { 'm/s': 1, 'cm/s': 0.01 },
  'angular velocity': { 'rad/s': 1, rpm: Math.PI / 30 },
  damping: { 'kg/s': 1, 'g/s': 0.001 },
  density: { 'kg/m^3': 1, 'g/cm^3': 1000 },
  number: { '': 1 },
}
type Dimension = keyof typeof UNITS

const number = (label: string, dimension: Dimension, unit: string, more: Partial<NumberField> = {}): NumberField => ({
  type: 'number',
  label,
  said: '',
  dimension,
  unit,
  min: 0,
  max: 1,
  decades: false,
  example: 0.5,
  ...more,
})
const vector = (label: string, dimension: Dimension, unit: string): VectorField => ({
  ...number(label, dimension, unit),
  type: 'vector',
  names: ['x', 'y', 'z'],
})
const kind = (label: string, more: object = {}) => ({ label, said: `${label}, in a sentence.`, fields: {}, ...more })

const RADIUS = number('Radius', 'length', 'mm')
const MASS = number('Mass', 'mass', 'g')
const RATIO = number('Inertia ratio', 'number', '')
const RATE = number('Rate', 'angular velocity', 'rpm')
const SIDE: ChoiceField = { type: 'choice', label: 'Side', said: '', words: ['in', 'out'], default: 'in' }
const SHAPE: FormulaField = { type: 'formula', label: 'z in x and y', said: '' }
const ball = { ball: true, start: {}, fields: { radius: RADIUS, mass: MASS } }
const place = (label: string, dimension: Dimension, unit: string) => ({ label, dimension, unit })

export const PARTS: Parts = {
  body: {
    pea: kind('Pea', { ...ball, inertia_ratio: 0.4, first: { kind: 'pea', radius: '3 mm', mass: '1 g' } }),
    bead: kind('Bead', { ...ball, inertia_ratio: 0.6, first: { kind: 'bead', radius: '2 mm', mass: '2 g' } }),
    'any-pea': kind('Any pea', {
      ...ball,
      inertia_ratio: 0.5,
      fields: { ...ball.fields, inertia_ratio: RATIO },
      first: { kind: 'any-pea', radius: '3 mm', mass: '1 g', inertia_ratio: 0.5 },
    }),
    penny: kind('Penny', {
      ...ball,
      ball: false,
      inertia_ratio: null,
      start: { attitude: [0, '80 deg', 0] },
      first: { kind: 'penny', radius: '12 mm', mass: '8 g' },
    }),
  },
  support: {
    desk: kind('Desk', {
      fields: {
        tilt: number('Tilt', 'angle', 'deg', { default: 0 }),
        rim: number('Rim', 'length', 'm', { optional: true, example: '50 cm', said: 'Absent: no end.' }),
      },
      first: { kind: 'desk', rim: '50 cm' },
      coordinates: [place('Position x', 'length', 'cm'), place('Position y', 'length', 'cm')],
      start: { position: ['15 cm', 0], velocity: [0, 0] },
    }),
    hose: kind('Hose', {
      fields: { girth: number('Girth', 'length', 'cm'), side: SIDE, formula: SHAPE },
      first: { kind: 'hose', girth: '40 cm', formula: 'x' },
      coordinates: [place('Angle about the axis', 'angle', 'deg'), place('Height along the axis', 'length', 'cm')],
      start: { position: ['30 deg', 0], velocity: [0, '50 cm/s'] },
    }),
  },
  motion: {
    still: kind('Still', { first: { kind: 'still' }, rate: null }),
    whirl: kind('Whirls', { fields: { rate: RATE }, first: { kind: 'whirl', rate: '33.3 rpm' }, rate: 'rate' }),
    reel: kind('Reels', {
      fields: { speed: RATE, phase: number('Phase', 'angle', 'deg', { default: 0 }) },
      first: { kind: 'reel', speed: '10 rpm' },
      rate: 'speed',
    }),
    both: kind('Both', { first: null, rate: null }),
  },
  loads: {
    wind: kind('Wind', {
      fields: { strength: number('Wind', 'damping', 'g/s') },
      first: { kind: 'wind', strength: '10 g/s' },
      usual: true,
    }),
    pull: kind('Pull', {
      fields: { value: vector('Pull', 'number', '') },
      first: { kind: 'pull', value: [1, 0, 0] },
      usual: false,
    }),
  },
  common: {
    scenario: { gravity: number('Gravity', 'number', '', { default: 9.8 }) },
    support: {
      friction: number('Friction coefficient', 'number', '', { optional: true, example: 0.3 }),
      kinetic_friction: number('While it slips', 'number', '', { optional: true }),
      restitution: number('Restitution', 'number', '', { default: 0 }),
    },
    start: {
      velocity: vector('Velocity', 'velocity', 'm/s'),
      spin: number('Spin', 'angular velocity', 'rad/s'),
      angular_velocity: vector('Angular velocity', 'angular velocity', 'rad/s'),
      height: number('Height', 'length', 'cm', { default: 0 }),
      time: number('Time', 'number', '', { default: 0 }),
    },
    run: { duration: number('Duration', 'number', ''), method: { ...SIDE, label: 'Method', words: ['auto', 'exact'] } },
    ball: { radius: RADIUS },
  },
  path: {
    ahead: { heading: number('Heading', 'angle', 'deg', { optional: true }), turn: number('Turn', 'angle', 'deg') },
    bend: { radius: RADIUS, angle: number('Angle', 'angle', 'deg') },
  },
  at_rest: 'still',
  units: UNITS,
} as unknown as Parts

/** A scenario made of them. */
export const PEA: Scenario = {
  title: 'A pea on a whirling desk',
  body: { kind: 'pea', radius: '25 mm', mass: '510 g' },
  support: { kind: 'desk', tilt: '0.3 deg', rim: '0.5 m', motion: { kind: 'whirl', rate: '33.3 rpm' } },
  start: { position: ['-4 cm', '-45 cm'], velocity: ['0 m/s', '0 m/s'] },
  run: { duration: '24 s', every: '10 ms', method: 'auto' },
}

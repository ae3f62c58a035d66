/** What a kind needs to be there at all, when it is chosen in the lab: sizes that make a good first picture. */
import type { Scenario, Table } from '../scenario'

type Kinds = Record<string, { label: string; keys: Table }>

export const BODIES: Kinds = {
  'solid-sphere': { label: 'Solid ball', keys: { radius: '25 mm', mass: '510 g' } },
  'hollow-sphere': { label: 'Hollow ball', keys: { radius: '20 mm', mass: '2.7 g' } },
  sphere: { label: 'Ball with any k', keys: { radius: '25 mm', mass: '500 g', inertia_ratio: 0.5 } },
  'eccentric-sphere': {
    label: 'Ball, its centre of mass off',
    keys: {
      radius: '25 mm',
      mass: '100 g',
      moments: ['2.5e-5 kg*m^2', '2.5e-5 kg*m^2', '2.5e-5 kg*m^2'],
      centre: [0, 0, '3 mm'],
    },
  },
  hemisphere: { label: 'Hemisphere', keys: { radius: '5 cm', mass: '200 g' } },
  disc: { label: 'Coin', keys: { radius: '12 mm', mass: '8 g' } },
  ring: { label: 'Hoop on its rim', keys: { radius: '20 cm', mass: '300 g' } },
  torus: { label: 'Torus', keys: { radius: '5 cm', rim_radius: '1 cm', mass: '200 g' } },
  ellipsoid: { label: 'Ellipsoid', keys: { semi_axes: ['5 cm', '4 cm', '3 cm'], mass: '200 g' } },
  cylinder: { label: 'Cylinder', keys: { radius: '5 cm', mass: '500 g' } },
  hoop: { label: 'Hoop, as a cylinder', keys: { radius: '5 cm', mass: '300 g' } },
}

/** Bodies whose attitude or laying is their own: their start is set up with them. */
const ATTITUDES: Record<string, Table> = {
  disc: { attitude: [0, '80 deg', 0], velocity: ['30 cm/s', 0] },
  ring: { attitude: [0, '80 deg', 0], velocity: ['2 m/s', 0] },
  torus: { attitude: [0, '80 deg', 0], velocity: ['1 m/s', 0] },
  hemisphere: { attitude: [0, '20 deg', 0] },
}

export const SURFACES: Kinds = {
  plane: { label: 'Table', keys: {} },
  bowl: { label: 'Bowl', keys: { radius: '40 cm', rim: '38 cm' } },
  dome: { label: 'Dome', keys: { radius: '40 cm' } },
  cone: { label: 'Funnel', keys: { half_angle: '45 deg', rim: '40 cm' } },
  paraboloid: { label: 'Dish', keys: { radius: '50 cm', rim: '40 cm' } },
  'ellipsoidal-bowl': { label: 'Elliptic bowl', keys: { semi_axes: ['40 cm', '30 cm', '25 cm'], depth: '20 cm' } },
  cylinder: { label: 'Upright cylinder, inside', keys: { radius: '40 cm' } },
  'torus-track': { label: 'Ring-shaped tube', keys: { ring_radius: '40 cm', tube_radius: '12 cm' } },
  'height-field': { label: 'Hills', keys: { formula: '0.02*sin(10*x)*cos(8*y)', rim: '50 cm' } },
  revolution: { label: 'Surface of revolution', keys: { formula: '0.5*r**2 - 0.8*r**4', rim: '40 cm' } },
}

export const MOTIONS: Kinds = {
  fixed: { label: 'At rest', keys: {} },
  spin: { label: 'Turns evenly', keys: { rate: '33.3 rpm' } },
  'uneven-spin': { label: 'Turns unevenly', keys: { rate: '33.3 rpm', variation: 0.05, variation_rate: '33.3 rpm' } },
  wobble: { label: 'Turns askew on its axle', keys: { rate: '33.3 rpm', angle: '1 deg' } },
  'spin-by': { label: 'Turns by a formula', keys: { rate: '3.487*(1 - exp(-t/2))' } },
  'free-axle': { label: 'Turns freely', keys: { rate: '33.3 rpm', inertia: '0.05 kg*m^2' } },
  rock: { label: 'Rocks', keys: { amplitude: '2 deg', rate: '1 turn/s' } },
  'precessing-tilt': { label: 'Leans round about', keys: { angle: '2 deg', rate: '0.5 turn/s' } },
  shake: { label: 'Shakes', keys: { amplitude: ['1 cm', 0, 0], rate: '1 turn/s' } },
}

export const LOADS: Kinds = {
  drag: { label: 'Drag of the air', keys: { coefficient: '2 g/s' } },
  force: { label: 'Force', keys: { value: ['0.1 N', 0, 0] } },
  torque: { label: 'Torque', keys: { value: [0, '2 mN*m', 0] } },
  'rolling-resistance': { label: 'Rolling resistance', keys: { offset: '0.1 mm' } },
  'pivot-friction': { label: 'Pivot friction', keys: { offset: '0.2 mm' } },
  'quadratic-drag': { label: 'Quadratic drag', keys: { coefficient: '0.4 g/m' } },
  magnus: { label: 'Magnus force', keys: { coefficient: '1 g' } },
}

/** Balls roll any way; what else is round keeps its shape's own start. */
export const ROUND = new Set(['solid-sphere', 'hollow-sphere', 'sphere', 'sphere-with-moment'])

/** Surfaces a place on which is said by two angles or an angle and a height. */
export const ANGULAR = new Set(['cylinder', 'torus-track'])

/** Another body: mass and radius stay between balls, the rest of its keys are its own. */
export function withBody(scenario: Scenario, kind: string): Scenario {
  const chosen = BODIES[kind]
  if (!chosen) return scenario
  const both = ROUND.has(kind) && ROUND.has(scenario.body.kind)
  const { radius, mass } = scenario.body
  const kept: Table = both ? { ...(radius !== undefined && { radius }), ...(mass !== undefined && { mass }) } : {}
  const body = { kind, ...chosen.keys, ...kept }
  if (both) return { ...scenario, body }
  const { position, velocity } = scenario.start
  const start = { position: position ?? [0, 0], ...(velocity !== undefined && { velocity }), ...ATTITUDES[kind] }
  return { ...scenario, body, start }
}

/** Another surface: how it moves and its friction stay; the start goes to a place that the new one has. */
export function withSurface(scenario: Scenario, kind: string): Scenario {
  const chosen = SURFACES[kind]
  if (!chosen) return scenario
  const { motion, friction, kinetic_friction, restitution, tangential_restitution } = scenario.support
  const kept = { motion, friction, kinetic_friction, restitution, tangential_restitution }
  const support = { kind, ...chosen.keys } as Scenario['support']
  for (const [key, value] of Object.entries(kept)) if (value !== undefined) support[key] = value
  const position = ANGULAR.has(kind) ? ['30 deg', 0] : ['15 cm', 0]
  const velocity = kind === 'plane' ? [0, 0] : [0, '50 cm/s']
  const { spin } = scenario.start
  return { ...scenario, support, start: { position, velocity, ...(spin !== undefined && { spin }) } }
}

/** Another motion: the rate stays where both have one. */
export function withMotion(scenario: Scenario, kind: string): Scenario {
  const { motion: before, ...support } = scenario.support
  if (kind === 'fixed') return { ...scenario, support: support as Scenario['support'] }
  const keys = { ...MOTIONS[kind]?.keys }
  const turns = (one: string | undefined) => ['spin', 'uneven-spin', 'wobble', 'free-axle'].includes(one ?? '')
  if (turns(before?.kind) && turns(kind) && before?.rate !== undefined) keys.rate = before.rate
  return { ...scenario, support: { ...support, motion: { kind, ...keys } } as Scenario['support'] }
}

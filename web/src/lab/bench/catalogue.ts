/** What the controls know of each key of a scenario: its name in words, its kind, and a range for its slider. */
import type { Kind } from '../quantity'

export interface Entry {
  label: string
  kind: Kind
  /** Range of the slider, SI. It widens where the value lies outside. */
  min: number
  max: number
  /** The slider goes by decades. */
  decades?: boolean
  /** Units offered; default: all that the kind has. */
  units?: string[]
  hint?: string
}

const size = (label: string, max = 0.1): Entry => ({ label, kind: 'length', min: max / 1000, max, decades: true })
const turn = (label: string, most = Math.PI): Entry => ({ label, kind: 'angle', min: -most, max: most })
const rate = (label: string): Entry => ({ label, kind: 'angular velocity', min: -10, max: 10 })

const BODY: Record<string, Entry> = {
  radius: { label: 'Radius', kind: 'length', min: 0.002, max: 0.2, decades: true },
  mass: { label: 'Mass', kind: 'mass', min: 0.001, max: 10, decades: true },
  inertia_ratio: {
    label: 'Inertia ratio k',
    kind: 'number',
    min: 0.01,
    max: 2 / 3,
    hint: 'k = I / (m a²): 2/5 solid, 2/3 a thin shell',
  },
  rim_radius: size('Radius of the rim', 0.05),
  density: { label: 'Density', kind: 'density', min: 100, max: 20000, decades: true },
  thickness: size('Thickness', 0.05),
  length: size('Length', 0.5),
  moment_of_inertia: { label: 'Moment of inertia', kind: 'inertia', min: 1e-8, max: 1, decades: true },
  weight: { label: 'Weight inside', kind: 'mass', min: 0.001, max: 10, decades: true },
  distance: size('Weight off the axis', 0.2),
  turn: turn('Turn of the inertia'),
}

const SUPPORT: Record<string, Entry> = {
  tilt: { label: 'Tilt', kind: 'angle', min: -Math.PI / 12, max: Math.PI / 12, units: ['deg', 'rad'] },
  radius: { label: 'Radius of the surface', kind: 'length', min: 0.05, max: 2, decades: true },
  half_angle: { label: 'Half angle of the cone', kind: 'angle', min: 0.1, max: 1.5, units: ['deg', 'rad'] },
  depth: size('Depth', 1),
  ring_radius: { label: 'Radius of the ring', kind: 'length', min: 0.05, max: 2, decades: true },
  tube_radius: { label: 'Radius of the tube', kind: 'length', min: 0.01, max: 1, decades: true },
  rim: {
    label: 'Rim',
    kind: 'length',
    min: 0.05,
    max: 5,
    decades: true,
    hint: 'the run ends where the contact reaches it',
  },
  friction: { label: 'Friction coefficient', kind: 'number', min: 0, max: 1 },
  kinetic_friction: { label: 'While it slips', kind: 'number', min: 0, max: 1 },
  restitution: { label: 'Restitution', kind: 'number', min: 0, max: 1 },
  tangential_restitution: { label: 'Restitution of the slip', kind: 'number', min: 0, max: 1 },
}

const MOTION: Record<string, Entry> = {
  rate: { ...rate('Rate'), units: ['rpm', 'rad/s', 'turn/s', 'deg/s'] },
  variation: { label: 'Variation', kind: 'number', min: 0, max: 0.5 },
  variation_rate: rate('Rate of the variation'),
  angle: { label: 'Angle', kind: 'angle', min: -Math.PI / 12, max: Math.PI / 12, units: ['deg', 'rad'] },
  amplitude: turn('Amplitude', Math.PI / 12),
  phase: turn('Phase'),
  inertia: { label: 'Inertia of the table', kind: 'inertia', min: 1e-4, max: 10, decades: true },
  motor_torque: { label: 'Motor', kind: 'torque', min: -0.5, max: 0.5 },
  bearing_drag: { label: 'Viscous bearing', kind: 'rotational damping', min: 0, max: 0.01 },
  bearing_torque: { label: 'Dry bearing', kind: 'torque', min: 0, max: 0.01 },
  below: rate('Eases off below'),
}

const START: Record<string, Entry> = {
  spin: { ...rate('Spin about the normal'), min: -40, max: 40, units: ['rad/s', 'rpm', 'turn/s'] },
  height: { label: 'Height over the support', kind: 'length', min: 0, max: 1 },
  roll: turn('Rolled on by'),
}

const LOADS: Record<string, Entry> = {
  'drag.coefficient': { label: 'Drag', kind: 'damping', min: 0, max: 0.05, hint: 'force −c V through the air' },
  'quadratic-drag.coefficient': { label: 'Quadratic drag', kind: 'quadratic damping', min: 0, max: 0.01 },
  'rolling-resistance.offset': { label: 'Rolling resistance', kind: 'length', min: 0, max: 0.002 },
  'pivot-friction.offset': { label: 'Pivot friction', kind: 'length', min: 0, max: 0.005 },
  'rolling-couple.coefficient': { label: 'Rolling couple', kind: 'rotational damping', min: 0, max: 1e-3 },
  'rolling-couple.pivot_coefficient': {
    label: 'Its part about the normal',
    kind: 'rotational damping',
    min: 0,
    max: 1e-3,
  },
  'magnus.coefficient': { label: 'Magnus force', kind: 'mass', min: -0.01, max: 0.01 },
}

const RUN: Record<string, Entry> = {
  duration: { label: 'Duration', kind: 'time', min: 0.5, max: 300, decades: true },
  every: { label: 'Between samples', kind: 'time', min: 1e-3, max: 0.1, decades: true },
}

const VECTORS: Record<string, { label: string; kind: Kind; reach: number; names: string[] }> = {
  'body.semi_axes': { label: 'Semi-axis', kind: 'length', reach: 0.2, names: ['1', '2', '3'] },
  'body.centre': { label: 'Centre of the shape', kind: 'length', reach: 0.02, names: ['x', 'y', 'z'] },
  'body.moments': { label: 'Moment', kind: 'inertia', reach: 1e-3, names: ['xx', 'yy', 'zz'] },
  'body.products': { label: 'Product', kind: 'inertia', reach: 1e-3, names: ['xy', 'xz', 'yz'] },
  'support.semi_axes': { label: 'Semi-axis', kind: 'length', reach: 1, names: ['x', 'y', 'z'] },
  'support.motion.amplitude': { label: 'Amplitude', kind: 'length', reach: 0.05, names: ['x', 'y', 'z'] },
  'support.motion.position': { label: 'Way', kind: 'length', reach: 0.5, names: ['x', 'y', 'z'] },
  'support.motion.axis': { label: 'Axis', kind: 'number', reach: 1, names: ['x', 'y', 'z'] },
  'start.velocity': { label: 'Velocity', kind: 'velocity', reach: 1, names: ['x', 'y', 'z'] },
  'start.angular_velocity': { label: 'Angular velocity', kind: 'angular velocity', reach: 60, names: ['x', 'y', 'z'] },
  'start.orientation': { label: 'Orientation', kind: 'number', reach: 1, names: ['w', 'x', 'y', 'z'] },
  'start.attitude': { label: 'Attitude', kind: 'angle', reach: Math.PI, names: ['heading', 'lean', 'turn'] },
  'force.value': { label: 'Force', kind: 'force', reach: 2, names: ['x', 'y', 'z'] },
  'torque.value': { label: 'Torque', kind: 'torque', reach: 0.05, names: ['x', 'y', 'z'] },
  'motor.value': { label: 'Motor torque', kind: 'torque', reach: 0.05, names: ['x', 'y', 'z'] },
}

const TABLES: Record<string, Record<string, Entry>> = {
  body: BODY,
  support: SUPPORT,
  'support.motion': MOTION,
  start: START,
  run: RUN,
}

/** The entry of a key of a table ("support.motion", "rate"), or undefined where it is no number. */
export function entry(table: string, key: string): Entry | undefined {
  return TABLES[table]?.[key]
}

/** The entry of a load's key ("drag", "coefficient"). */
export function loadEntry(kind: string, key: string): Entry | undefined {
  return LOADS[`${kind}.${key}`]
}

/** The entry of one component of a vector ("start.velocity", 0, 2). */
export function component(vector: string, index: number): Entry | undefined {
  const known = VECTORS[vector]
  if (!known) return undefined
  const { label, kind, reach, names } = known
  return { label: `${label} ${names[index] ?? index + 1}`, kind, min: -reach, max: reach }
}

/** The keys of a table that a slider can show, in the order of reading. */
export function keysOf(table: string): string[] {
  return Object.keys(TABLES[table] ?? {})
}

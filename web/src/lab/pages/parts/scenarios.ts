/** The scenarios that these pages start from; they are those that ship, cut down to what a page needs. */
import { parse } from '../../quantity'
import type { Scenario } from '../../scenario'

const STEEL = { kind: 'solid-sphere', radius: '25 mm', mass: '510 g' }
const TURNING = { kind: 'spin', rate: '33.3 rpm' }

export const CYLINDER: Scenario = {
  title: 'Cylinder down an incline',
  body: { kind: 'cylinder', radius: '30 mm', mass: '200 g' },
  support: { kind: 'plane', tilt: '12 deg' },
  start: { position: ['0 m', '0 m'], velocity: ['0 m/s', '0 m/s'] },
  run: { duration: '0.8 s', every: '2.5 ms', method: 'auto' },
}

const TORQUE = 2.5 // mN*m, of a push at the top

/** A level push of 0.1 N, at this share of the radius above the ball's centre: a force and its torque. */
export function pushed(share: number): Scenario {
  const torque = Number((share * TORQUE).toPrecision(6))
  return {
    title: 'Ball on a level plane, pushed',
    body: STEEL,
    support: { kind: 'plane' },
    start: { position: ['0 m', '0 m'], velocity: ['0 m/s', '0 m/s'] },
    loads: [
      { kind: 'force', value: ['0.1 N', '0 N', '0 N'] },
      ...(torque ? [{ kind: 'torque', value: ['0 N*m', `${torque} mN*m`, '0 N*m'] }] : []),
    ],
    run: { duration: '2.5 s', every: '5 ms', method: 'auto' },
  }
}

/** At which share of the radius a push is. */
export function shareOf({ loads }: Scenario): number {
  const torque = loads?.[1]?.value
  return Array.isArray(torque) ? (parse(torque[1]).number ?? 0) / TORQUE : 0
}

export const LEVEL: Scenario = {
  title: 'Steel ball on a level turntable',
  body: STEEL,
  support: { kind: 'plane', rim: '0.5 m', motion: TURNING },
  start: { position: ['20 cm', '0 cm'], velocity: ['0 m/s', '0.1 m/s'] },
  run: { duration: '20 s', every: '10 ms', method: 'auto' },
}

export const PUT_DOWN: Scenario = {
  ...LEVEL,
  title: 'Steel ball put down gently on a level turntable',
  start: { position: ['20 cm', '0 cm'], velocity: ['0 m/s', '0 m/s'] },
}

/** Put down at that end of the table from which the drift leads across it. Tilt in degrees, rate in rpm. */
export function leaning(tilt = 0.3, rate = 33.3): Scenario {
  const side = rate * tilt >= 0 ? -45 : 45
  return {
    title: 'Steel ball put down gently on a slightly tilted turntable',
    body: STEEL,
    support: { kind: 'plane', tilt: `${tilt} deg`, rim: '0.5 m', motion: { kind: 'spin', rate: `${rate} rpm` } },
    start: { position: ['-4 cm', `${side} cm`], velocity: ['0 m/s', '0 m/s'] },
    run: { duration: '24 s', every: '10 ms', method: 'auto' },
  }
}

/** What lies on the bench when nothing else was asked for: the lecture's demonstration. */
import type { Scenario } from './scenario'

export const FIRST_NAME = 'tilted-turntable-put-down'

export const FIRST: Scenario = {
  title: 'Steel ball put down gently on a slightly tilted turntable',
  body: { kind: 'solid-sphere', radius: '25 mm', mass: '510 g' },
  support: { kind: 'plane', tilt: '0.3 deg', rim: '0.5 m', motion: { kind: 'spin', rate: '33.3 rpm' } },
  start: { position: ['-4 cm', '-45 cm'], velocity: ['0 m/s', '0 m/s'] },
  run: { duration: '24 s', every: '10 ms', method: 'auto' },
}

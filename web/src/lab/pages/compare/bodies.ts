/** What can be put on the table side by side, each as a scenario of its own: same table, same start. */
import { type Scenario, withValues } from '../../scenario'

export interface Contestant {
  id: string
  name: string
  /** I/(m a²) in words, and the share of the table's rate that theory gives. */
  ratio: string
  share: string
  note: string
  /** A guess, not what happens. */
  wrong: boolean
  scenario(table: Table): Scenario
}

export interface Table {
  /** rpm */
  rate: number
  /** degrees */
  tilt: number
  /** cm/s, along the second axis */
  push: number
}

const RADIUS = 0.025
const MASS = 0.51
/** Of the guess "carried along": so hard to spin that it cannot but ride on the table. */
const IMMOVABLE = 1e6

/** Three equal moments, as many times m a² as wanted: no sphere has more than 2/3, but the law does not mind. */
function withRatio(ratio: number): Scenario['body'] {
  const moment = Number((ratio * MASS * RADIUS * RADIUS).toPrecision(12))
  return { kind: 'eccentric-sphere', radius: RADIUS, mass: MASS, moments: [moment, moment, moment] }
}

const ROUND: Record<'solid' | 'hollow', Scenario['body']> = {
  solid: { kind: 'solid-sphere', radius: RADIUS, mass: MASS },
  hollow: { kind: 'hollow-sphere', radius: RADIUS, mass: MASS },
}

function on(table: Table, body: Scenario['body'], title: string): Scenario {
  return {
    title,
    body,
    support: {
      kind: 'plane',
      rim: '0.5 m',
      ...(table.tilt ? { tilt: `${table.tilt} deg` } : {}),
      motion: { kind: 'spin', rate: `${table.rate} rpm` },
    },
    start: startOf(table),
    run: { duration: '20 s', every: '40 ms', method: 'auto' },
  }
}

/** Level: near the right edge. Leaning: near the lower left, so that there is room for the drift. */
function startOf({ tilt, push }: Table): Scenario['start'] {
  const position = tilt ? ['-4 cm', '-40 cm'] : ['20 cm', '0 cm']
  return { position, velocity: ['0 cm/s', `${push} cm/s`] }
}

/** On ice: nothing of the table's turning reaches it. */
function withoutFriction(scenario: Scenario): Scenario {
  return withValues(scenario, [
    ['support.friction', 0],
    ['start.angular_velocity', [0, 0, 0]],
  ])
}

/** Level: carried along. Leaning: straight downhill, as if the table stood still. */
function intuition(table: Table): Scenario {
  if (table.tilt) return withoutFriction({ ...on({ ...table, push: 0 }, ROUND.solid, 'Intuition: downhill') })
  const riding = on(table, withRatio(IMMOVABLE), 'Intuition: carried along')
  return { ...riding, start: { position: startOf(table).position, velocity: 'co-rotating' } }
}

export const CONTESTANTS: readonly Contestant[] = [
  {
    id: 'solid',
    name: 'Solid ball',
    ratio: '2/5',
    share: '2/7',
    note: 'steel, glass, a marble',
    wrong: false,
    scenario: (table) => on(table, ROUND.solid, 'Solid ball'),
  },
  {
    id: 'hollow',
    name: 'Hollow ball',
    ratio: '2/3',
    share: '2/5',
    note: 'a thin shell, as in table tennis',
    wrong: false,
    scenario: (table) => on(table, ROUND.hollow, 'Hollow ball'),
  },
  {
    id: 'hoop',
    name: 'As a hoop',
    ratio: '1',
    share: '1/2',
    note: 'no sphere has as much: weights on arms beyond the surface',
    wrong: false,
    scenario: (table) => on(table, withRatio(1), 'As a hoop'),
  },
  {
    id: 'puck',
    name: 'Puck on ice',
    ratio: '–',
    share: '0',
    note: 'no friction: it does not know that the table turns',
    wrong: false,
    scenario: (table) => withoutFriction(on(table, ROUND.solid, 'Puck on ice')),
  },
  {
    id: 'intuition',
    name: 'What intuition says',
    ratio: '–',
    share: '1',
    note: 'a wrong guess',
    wrong: true,
    scenario: intuition,
  },
]

/** "2/7" as a number. */
export function fractionOf(share: string): number {
  const [above = '0', below = '1'] = share.split('/')
  return Number(above) / Number(below)
}

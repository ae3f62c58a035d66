import { beforeEach, expect, it, vi } from 'vitest'
import type { Scene } from '../../viewer/scene'
import type { Api, Simulated } from '../api'
import type { Scenario } from '../scenario'
import { createComputing, type Since } from './computing'

const SCENE = { header: { tolerance: 1e-12 }, columns: { time: [] } } as unknown as Scene

function setUp() {
  const answers: ((fails?: Error) => void)[] = []
  const told: Since[] = []
  const simulate = () =>
    new Promise<Simulated>((finish, fail) => {
      answers.push((why) => (why ? fail(why) : finish({ scene: SCENE, milliseconds: 1 } as Simulated)))
    })
  const api = { simulate, cancel: () => undefined, card: () => new Promise(() => undefined) } as unknown as Api
  const computing = createComputing(
    { api },
    {
      scene: (_scene, _milliseconds, since) => told.push(since),
      settled: () => undefined,
      failed: () => undefined,
      busy: () => undefined,
      card: () => undefined,
      curves: false,
    },
  )
  const answered = async (which: number, fails?: Error) => {
    await Promise.resolve()
    answers[which]!(fails)
    await vi.advanceTimersByTimeAsync(0)
  }
  return { computing, answered, told }
}

const titled = (title: string) => ({ title }) as Scenario
const FIRST = { fresh: true, restart: false, again: false }

beforeEach(() => void vi.useFakeTimers())

it('tells what is opened from what changes', async () => {
  const { computing, answered, told } = setUp()
  computing.ask(titled('one'))
  await answered(0)
  computing.ask(titled('one, changed'), { source: 'control' })
  await answered(1)
  computing.ask(titled('two'), { source: 'open', opens: true })
  await answered(2)
  expect(told).toEqual([FIRST, { ...FIRST, fresh: false }, FIRST])
})

it('takes a late scene of the scenario before for no scene of the one that was opened since', async () => {
  const { computing, answered, told } = setUp()
  computing.ask(titled('one'))
  await answered(0)
  computing.ask(titled('one, changed'), { source: 'control' })
  await Promise.resolve()
  computing.ask(titled('two'), { source: 'open', opens: true })
  await answered(1)
  await answered(2)
  expect(told).toEqual([FIRST, { ...FIRST, fresh: false }, FIRST])
})

it('begins a motion anew with the scene that was asked for, not with one that was on its way', async () => {
  const { computing, answered, told } = setUp()
  computing.ask(titled('one'))
  await Promise.resolve()
  computing.ask(titled('nudged'), { source: 'nudge', restarts: true })
  await answered(0)
  await answered(1)
  expect(told).toEqual([FIRST, { fresh: false, restart: true, again: false }])
})

it('opens what can be run after a change, though it could not at first', async () => {
  const { computing, answered, told } = setUp()
  computing.ask(titled('one'))
  await answered(0)
  computing.ask(titled('two'), { source: 'open', opens: true })
  await answered(1, new Error('no start'))
  computing.ask(titled('two, mended'), { source: 'control' })
  await answered(2)
  expect(told).toEqual([FIRST, FIRST])
})

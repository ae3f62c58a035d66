import { expect, it, vi } from 'vitest'
import { createLanes } from './lanes'
import { createRunner } from './runner'

interface Job {
  request: number
  signal: AbortSignal
  finish(answer: string): void
  fail(error: Error): void
}

function setUp(patience = 100) {
  const jobs: Job[] = []
  const done: string[] = []
  const failed: string[] = []
  const busy: boolean[] = []
  let waiting: (() => void)[] = []
  const clock = { now: 0 }
  const runner = createRunner<number, string>({
    patience,
    run: (request, signal) =>
      new Promise((finish, fail) => {
        jobs.push({ request, signal, finish, fail })
      }),
    done: (answer) => done.push(answer),
    failed: (error) => failed.push(String(error)),
    state: (now) => busy.push(now),
    soon: (callback) => waiting.push(callback),
    now: () => clock.now,
  })
  const begin = () => {
    const due = waiting
    waiting = []
    for (const callback of due) callback()
  }
  return { runner, jobs, done, failed, busy, begin, clock }
}

const settled = () => new Promise((resolve) => setTimeout(resolve))

it('runs only the newest of a task', () => {
  const { runner, jobs, begin } = setUp()
  runner.ask(1)
  runner.ask(2)
  runner.ask(3)
  begin()
  expect(jobs.map((job) => job.request)).toEqual([3])
})

it('lets a young job finish and shows it, then runs the newest that waited', async () => {
  const { runner, jobs, done, begin } = setUp()
  runner.ask(1)
  begin()
  runner.ask(2)
  runner.ask(3)
  begin()
  expect(jobs).toHaveLength(1)
  jobs[0]!.finish('one')
  await settled()
  begin()
  expect(done).toEqual(['one'])
  expect(jobs.map((job) => job.request)).toEqual([1, 3])
})

it('aborts a job that is overdue, and never shows what it says later', async () => {
  const { runner, jobs, done, failed, begin, clock } = setUp(100)
  runner.ask(1)
  begin()
  clock.now = 150
  runner.ask(2)
  begin()
  expect(jobs[0]!.signal.aborted).toBe(true)
  expect(jobs.map((job) => job.request)).toEqual([1, 2])
  jobs[1]!.finish('two')
  jobs[0]!.finish('one')
  await settled()
  expect(done).toEqual(['two'])
  expect(failed).toEqual([])
})

it('aborts it when its time is up while a newer one waits', () => {
  vi.useFakeTimers()
  const { runner, jobs, begin, clock } = setUp(100)
  runner.ask(1)
  begin()
  runner.ask(2)
  begin()
  clock.now = 101
  vi.advanceTimersByTime(101)
  expect(jobs[0]!.signal.aborted).toBe(true)
  expect(jobs).toHaveLength(2)
  vi.useRealTimers()
})

it('tells of an error, but not of one that is old', async () => {
  const { runner, jobs, failed, begin } = setUp()
  runner.ask(1)
  begin()
  runner.ask(2)
  jobs[0]!.fail(new Error('old'))
  await settled()
  begin()
  jobs[1]!.fail(new Error('new'))
  await settled()
  expect(failed).toEqual(['Error: new'])
})

it('says nothing more once it is stopped', async () => {
  const { runner, jobs, done, busy, begin } = setUp()
  runner.ask(1)
  begin()
  runner.stop()
  expect(busy).toEqual([true, false])
  jobs[0]!.finish('one')
  await settled()
  expect(jobs[0]!.signal.aborted).toBe(true)
  expect(done).toEqual([])
  runner.stop()
  expect(busy).toEqual([true, false])
})

it('keeps one request in a lane, and lanes apart', () => {
  const lanes = createLanes()
  const outer = new AbortController()
  const first = lanes.enter('simulate')
  const card = lanes.enter('card', outer.signal)
  const free = lanes.enter(null)
  const second = lanes.enter('simulate')
  expect([first, card, free, second].map((one) => one.signal.aborted)).toEqual([true, false, false, false])
  outer.abort()
  expect(card.signal.aborted).toBe(true)
  second.leave()
  lanes.enter('simulate')
  expect(second.signal.aborted).toBe(false)
})

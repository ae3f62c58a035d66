import { expect, it, vi } from 'vitest'
import type { Json, Scenario } from '../scenario'
import { endsOf } from './ends'

/** A slider from 0 to 1 that says its place, standing at `now`. */
function slider(now: number) {
  return { now: () => now, at: (share: number) => share, share: () => now, with: (value: Json) => value as never }
}

const upTo = (most: number) => (all: Scenario[]) =>
  Promise.resolve(
    all.map((one) => ((one as unknown as number) <= most ? null : { message: `${most} is all`, key: null })),
  )

it('finds the last value that can start, by halves', async () => {
  const [ends] = await endsOf([slider(0.2)], upTo(0.7), (text) => `So: ${text}`)
  expect(ends?.low).toBeNull()
  expect(ends?.high?.why).toBe('So: 0.7 is all')
  expect(ends?.high?.value).toBeGreaterThan(0.69)
  expect(ends?.high?.value).toBeLessThanOrEqual(0.7)
})

it('leaves what can go nowhere where it is', async () => {
  const never = (all: Scenario[]) => Promise.resolve(all.map(() => ({ message: 'no', key: null })))
  const [ends] = await endsOf([slider(0.4)], never, (text) => text)
  expect(ends).toEqual({ low: { value: 0.4, why: 'no' }, high: { value: 0.4, why: 'no' } })
})

it('asks of all sliders together, and only once where all can start', async () => {
  const possible = vi.fn(upTo(2))
  await endsOf([slider(0.1), slider(0.9)], possible, (text) => text)
  expect(possible.mock.calls.map(([all]) => all)).toEqual([[0, 1, 0, 1]])
})

import { expect, it, vi } from 'vitest'
import { tellWhileStarting } from './starting'

const answers = (...said: (boolean | Error)[]) => ({
  ready: async () => {
    const next = said.shift()
    if (next instanceof Error || next === undefined) throw next
    return { ready: next }
  },
})
const atOnce = async () => undefined

it('says once that the workers start, and takes it back when one has answered', async () => {
  const [hold, release] = [vi.fn(), vi.fn()]
  hold.mockImplementation(() => release)
  await tellWhileStarting(answers(false, false, true), hold, atOnce)
  expect(hold).toHaveBeenCalledExactlyOnceWith(expect.stringContaining('Starting the workers'))
  expect(release).toHaveBeenCalledOnce()
})

it('says nothing where they are there', async () => {
  const hold = vi.fn()
  await tellWhileStarting(answers(true), hold, atOnce)
  expect(hold).not.toHaveBeenCalled()
})

it('does not go on saying so when the server has ended', async () => {
  const release = vi.fn()
  await tellWhileStarting(answers(false, new TypeError('fetch failed')), () => release, atOnce)
  expect(release).toHaveBeenCalledOnce()
})

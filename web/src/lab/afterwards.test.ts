import { afterEach, beforeEach, expect, it, vi } from 'vitest'
import { createAfterwards } from './afterwards'

beforeEach(() => void vi.useFakeTimers())
afterEach(() => void vi.useRealTimers())

function setUp() {
  const frames: (() => void)[] = []
  const done: string[] = []
  const afterwards = createAfterwards((callback) => frames.push(callback))
  const frame = () => {
    for (const callback of frames.splice(0)) callback()
    vi.runAllTimers()
  }
  return { afterwards, done, frame }
}

it('waits for a frame, and does only the newest of its jobs', () => {
  const { afterwards, done, frame } = setUp()
  afterwards.run(() => done.push('first'))
  afterwards.run(() => done.push('second'))
  expect(done).toEqual([])
  expect(afterwards.waiting).toBe(true)
  frame()
  expect(done).toEqual(['second'])
  expect(afterwards.waiting).toBe(false)
  afterwards.run(() => done.push('third'))
  frame()
  expect(done).toEqual(['second', 'third'])
})

it('does nothing more once it is stopped', () => {
  const { afterwards, done, frame } = setUp()
  afterwards.run(() => done.push('first'))
  afterwards.stop()
  frame()
  expect(done).toEqual([])
})

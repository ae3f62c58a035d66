import { afterEach, beforeEach, expect, test, vi } from 'vitest'
import { type Sharpened, Sharpness } from './sharpness'

beforeEach(() => void vi.useFakeTimers())
afterEach(() => void vi.useRealTimers())

class Picture implements Sharpened {
  share = 1
  readonly drawn: number[] = []
  constructor(readonly byProcessor: boolean) {}
  sharpen(share: number): void {
    this.share = share
  }
  readonly draw = () => void this.drawn.push(this.share)
}

function setUp({ byProcessor }: { byProcessor: boolean }) {
  const picture = new Picture(byProcessor)
  return { picture, sharpness: new Sharpness(picture, picture.draw) }
}

test('a graphics card draws every change in full, at once', () => {
  const { picture, sharpness } = setUp({ byProcessor: false })
  for (let i = 0; i < 10; i++) {
    sharpness.changed()
    expect(picture.share).toBe(1)
    vi.advanceTimersByTime(20)
  }
  vi.advanceTimersByTime(5000)
  expect(picture.drawn).toEqual([])
})

test('the processor draws changes coarsely, and the last of them once more in full', () => {
  const { picture, sharpness } = setUp({ byProcessor: true })
  for (let i = 0; i < 10; i++) {
    sharpness.changed()
    expect(picture.share).toBeLessThan(0.7)
    vi.advanceTimersByTime(100)
  }
  expect(picture.drawn).toEqual([])
  vi.advanceTimersByTime(5000)
  expect(picture.drawn).toEqual([1])
})

test('play is not interrupted by a full picture, and what stands still after it is drawn in full', () => {
  const { picture, sharpness } = setUp({ byProcessor: true })
  sharpness.changed()
  for (let i = 0; i < 40; i++) {
    sharpness.frame(16 * i)
    vi.advanceTimersByTime(16)
    expect(picture.share).toBeLessThan(0.7)
  }
  expect(picture.drawn).toEqual([])
  sharpness.changed()
  vi.advanceTimersByTime(5000)
  expect(picture.drawn).toEqual([1])
})

test('what rests is drawn in full at once, the next change coarsely again', () => {
  const { picture, sharpness } = setUp({ byProcessor: true })
  sharpness.changed()
  sharpness.rest()
  sharpness.changed()
  expect(picture.share).toBe(1)
  sharpness.changed()
  expect(picture.share).toBeLessThan(0.7)
})

test('nothing is drawn after the end', () => {
  const { picture, sharpness } = setUp({ byProcessor: true })
  sharpness.changed()
  sharpness.dispose()
  vi.advanceTimersByTime(5000)
  expect(picture.drawn).toEqual([])
})

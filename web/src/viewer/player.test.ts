import { expect, test } from 'vitest'
import { nextSpeed, Player, watchable } from './player'

function player(begin = 0, duration = 10): Player {
  const made = new Player()
  made.load(begin, duration, false)
  return made
}

test('it goes by the page’s clock times the speed', () => {
  const it = player()
  it.speed = 2
  it.play()
  for (const now of [5000, 5016, 5133, 5500]) it.tick(now)
  expect(it.time).toBeCloseTo(1.0, 12)
})

test('it stops at the end, and says so once', () => {
  const it = player(1, 0.5)
  it.play()
  it.tick(0)
  expect(it.tick(300)).toBe(false)
  expect(it.tick(600)).toBe(true)
  expect([it.time, it.playing, it.tick(900)]).toEqual([1.5, false, false])
  it.play()
  expect(it.time).toBe(1)
})

test('it repeats without losing the time beyond the end', () => {
  const it = player(2, 1)
  it.loop = true
  it.play()
  for (const now of [0, 300, 600, 900, 1300]) it.tick(now)
  expect(it.time).toBeCloseTo(2.3, 12)
  expect(it.playing).toBe(true)
})

test('a page that was hidden for long does not make it leap', () => {
  const it = player()
  it.play()
  it.tick(0)
  it.tick(100)
  it.tick(60_000)
  it.tick(60_100)
  expect(it.time).toBeCloseTo(0.1 + 0.4 + 0.1, 12)
})

test('a pause does not count', () => {
  const it = player()
  it.play()
  it.tick(0)
  it.tick(100)
  it.pause()
  it.tick(500)
  it.play()
  it.tick(900)
  it.tick(1000)
  expect(it.time).toBeCloseTo(0.2, 12)
})

test('seeking keeps within the run, and a new run keeps the time if asked', () => {
  const it = player(0, 10)
  it.seek(99)
  expect(it.time).toBe(10)
  it.seek(Number.NaN)
  expect(it.time).toBe(0)
  it.seek(4)
  it.load(0, 6, true)
  expect(it.time).toBe(4)
  it.load(0, 3, true)
  expect(it.time).toBe(3)
  it.load(0, 6, false)
  expect(it.time).toBe(0)
})

test('a run without duration cannot be played', () => {
  const it = player(0, 0)
  it.play()
  expect(it.playing).toBe(false)
})

test('speeds go up and down by the usual steps and end there', () => {
  expect(nextSpeed(1, 1)).toBe(2)
  expect(nextSpeed(1, -1)).toBe(0.5)
  expect(nextSpeed(0.7, 1)).toBe(1)
  expect(nextSpeed(10, 1)).toBe(10)
  expect(nextSpeed(0.1, -1)).toBe(0.05)
  expect(nextSpeed(0.01, -1)).toBe(0.01)
})

test.each([
  [20, 5, 1],
  [20, 100, 1],
  [4, 150, 0.5],
  [0.16, 0, 0.1],
  [0.16, 3000, 0.02],
  [1e-6, 0, 0.01],
  [600, 0, 1],
])('a run of %d s that turns at %d rad/s can be watched at %d of its speed', (duration, turning, speed) => {
  expect(watchable(duration, turning)).toBe(speed)
})

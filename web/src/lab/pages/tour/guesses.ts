/** Guesses to pick for who does not draw: lines on the table, not motions. Metres, x down the slope. */
import type { Point } from './guess'

export type GuessName = 'downhill' | 'round' | 'level' | 'stays'

export const GUESSES: readonly (readonly [GuessName, string])[] = [
  ['downhill', 'Down the slope'],
  ['round', 'Round with the table'],
  ['level', 'Along the level'],
  ['stays', 'It stays there'],
]

export function guessed(name: GuessName, [x, y]: Point, rim: number): Point[] {
  if (name === 'stays') return [[x, y]]
  if (name === 'round') return roundTheAxis([x, y])
  if (name === 'level')
    return [
      [x, y],
      [x, Math.sqrt(Math.max(0, rim * rim - x * x))],
    ]
  return [
    [x, y],
    [Math.sqrt(Math.max(0, rim * rim - y * y)), y],
  ]
}

function roundTheAxis([x, y]: Point): Point[] {
  const [radius, from] = [Math.hypot(x, y), Math.atan2(y, x)]
  return Array.from({ length: 91 }, (_, i) => {
    const angle = from + (i / 90) * 1.9 * Math.PI
    return [radius * Math.cos(angle), radius * Math.sin(angle)]
  })
}

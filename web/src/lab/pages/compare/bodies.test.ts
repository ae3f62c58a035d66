import { describe, expect, it } from 'vitest'
import { CONTESTANTS, fractionOf, type Table } from './bodies'

const level: Table = { rate: 33.3, tilt: 0, push: 10 }
const leaning: Table = { rate: 33.3, tilt: 0.3, push: 0 }
const of = (id: string, table: Table) => CONTESTANTS.find((one) => one.id === id)!.scenario(table)

describe('what is compared', () => {
  it('shares table and start', () => {
    for (const table of [level, leaning]) {
      const scenarios = CONTESTANTS.filter(({ wrong }) => !wrong).map((one) => one.scenario(table))
      for (const scenario of scenarios) {
        expect(scenario.support.motion).toEqual({ kind: 'spin', rate: '33.3 rpm' })
        expect(scenario.start.position).toEqual(scenarios[0]!.start.position)
        expect(scenario.start.velocity).toEqual(scenarios[0]!.start.velocity)
      }
    }
  })

  it('has the share k/(1 + k) of each ratio', () => {
    for (const { ratio, share } of CONTESTANTS.filter((one) => one.ratio !== '–')) {
      const k = fractionOf(ratio)
      expect(fractionOf(share)).toBeCloseTo(k / (1 + k), 12)
    }
  })

  it('gives the ball of ratio 1 the moments m a²', () => {
    const { moments, mass, radius } = of('hoop', level).body as unknown as Record<string, number> & {
      moments: number[]
    }
    expect(moments[0]).toBeCloseTo(mass! * radius! ** 2, 15)
    expect(new Set(moments).size).toBe(1)
  })

  it('takes the friction from the puck, and its spin', () => {
    const puck = of('puck', level)
    expect(puck.support.friction).toBe(0)
    expect(puck.start.angular_velocity).toEqual([0, 0, 0])
    expect(of('solid', level).support.friction).toBeUndefined()
  })

  it('guesses "carried along" on the level and "downhill" where it leans', () => {
    expect(of('intuition', level).start.velocity).toBe('co-rotating')
    expect(of('intuition', leaning).support.friction).toBe(0)
    expect(of('intuition', leaning).start.velocity).toEqual(['0 cm/s', '0 cm/s'])
  })
})

import { describe, expect, it } from 'vitest'
import { dictionary, type TableRow, tidied } from './dictionary'

const rows: TableRow[] = [
  { name: 'mass', ball: 'm', ball_value: '0.51 kg', charge: 'M', charge_value: '0.51 kg' },
  {
    name: 'rate of turning',
    ball: 'κ = ω k/(1 + k)',
    ball_value: '0.996334 rad/s',
    charge: '−QB/M',
    charge_value: '0.996334 rad/s',
  },
  {
    name: 'drift',
    ball: '−φ/(iκ)',
    ball_value: '(0, -0.0368116) m/s',
    charge: 'E×B/B²',
    charge_value: '(0, -0.0368116) m/s',
  },
]

describe('the dictionary', () => {
  it('sets the formulas of both sides beside each other', () => {
    const [rate, drift] = dictionary(rows)
    expect(rate!.charge).toContain('qB')
    expect(rate!.ball).toContain('\\omega')
    expect(drift!.charge).toContain('\\times')
    expect(dictionary(rows)).toHaveLength(2)
  })

  it('says whether both sides agree', () => {
    expect(dictionary(rows).every(({ same }) => same)).toBe(true)
    const [off] = dictionary([{ ...rows[1]!, charge_value: '0.996335 rad/s' }])
    expect(off!.same).toBe(true) // to five digits
    const [far] = dictionary([{ ...rows[1]!, charge_value: '0.9961 rad/s' }])
    expect(far!.same).toBe(false)
  })

  it('leaves a row that it does not know as it came', () => {
    const [one] = dictionary([{ ...rows[1]!, name: 'something new' }])
    expect(one!.name).toBe('something new')
    expect(one!.ball).toBe('\\text{κ = ω k/(1 + k)}')
  })

  it('tidies numbers, not units', () => {
    expect(tidied('(0, -0.0368116) m/s')).toBe('(0, −0.036812) m/s')
    expect(tidied('9.80668 m/s2')).toBe('9.8067 m/s2')
    expect(tidied('1.23456789e-07 T')).toBe('1.2346e−7 T')
  })
})

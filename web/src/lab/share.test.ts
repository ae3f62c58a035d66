import { describe, expect, it } from 'vitest'
import { FIRST } from './first'
import type { Scenario } from './scenario'
import { decode, encode, isScenario, LinkError } from './share'

describe('the code of a scenario in the URL', () => {
  it('comes back as it went, whatever is written in it', async () => {
    const scenario: Scenario = { ...FIRST, title: 'Kugel „groß“ — 33⅓ rpm, 球', notes: 'two\nlines', gravity: 0 }
    expect(await decode(await encode(scenario))).toEqual(scenario)
  })
  it('needs no escaping in a URL, and is shorter than the text', async () => {
    const code = await encode(FIRST)
    expect(code).toMatch(/^[A-Za-z0-9_-]+$/)
    expect(code.length).toBeLessThan(JSON.stringify(FIRST).length)
  })
  it('says that it is damaged when a part is missing, changed or nonsense', async () => {
    const code = await encode(FIRST)
    const middle = code.length >> 1
    const changed = code.slice(0, middle) + (code[middle] === 'A' ? 'B' : 'A') + code.slice(middle + 1)
    for (const bad of [code.slice(0, -9), `${code}AAAA`.slice(5), changed, '%%%', 'A', '', 'ééé'])
      await expect(decode(bad)).rejects.toBeInstanceOf(LinkError)
  })
  it('refuses what is no scenario, and what unfolds too far', async () => {
    const other = await encode({ hello: 'world' } as unknown as Scenario)
    await expect(decode(other)).rejects.toThrow('holds no scenario')
    const bomb = await encode({ ...FIRST, notes: 'x'.repeat(2_000_000) })
    await expect(decode(bomb)).rejects.toThrow('unfolds to more')
    await expect(decode('A'.repeat(70_000))).rejects.toThrow('too long')
  })
  it('knows the two kinds of scenario', () => {
    expect(isScenario(FIRST)).toBe(true)
    expect(isScenario({ body: { radius: '25 mm' }, path: [{ kind: 'arc' }] })).toBe(true)
    for (const wrong of [null, [], 3, {}, { body: {}, support: {}, start: {}, run: {} }])
      expect(isScenario(wrong)).toBe(false)
  })
})

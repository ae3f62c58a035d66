/** Starts by hand: what the package says of them is written as the scenario writes its start now. */
import type { Scene } from '../../viewer/scene'
import type { Parts } from '../parts'
import { parse, write } from '../quantity'
import type { Json, Quantity, Scenario, Table } from '../scenario'
import { withValue } from '../scenario'

/** Why the body cannot be dragged here, or null where it can. */
export function whyNotDragged(scenario: Scenario): string | null {
  return scenario.support ? null : 'A ball that is rolled along a path starts where the path does.'
}

/** Why a run cannot be nudged, or null where it can. */
export function whyNotNudged(scenario: Scenario, scene: Scene | undefined): string | null {
  const why = whyNotDragged(scenario)
  if (why) return why
  if (scene && !scene.header.body.ball) return 'Nudging is for balls whose centre of mass is in the middle.'
  return null
}

const DIGITS: Record<string, number> = { position: 4, velocity: 3 }

/** The scenario with a start that was made by hand; each number in the unit in which the start says it now. */
export function put(scenario: Scenario, changes: Table, parts: Parts): Scenario {
  const places = parts.support[scenario.support.kind]?.coordinates ?? []
  const speeds = Array(3).fill({ dimension: 'velocity', unit: 'm/s' }) as typeof places
  return Object.entries(changes).reduce((now, [key, value]) => {
    if (!Array.isArray(value)) return withValue(now, `start.${key}`, value ?? undefined)
    const before = now.start[key]
    const had = Array.isArray(before) ? before : []
    const kinds = key === 'position' ? places : speeds
    const said = value.map((si, index): Quantity => {
      const { dimension = '', unit: usual = '' } = kinds[index] ?? {}
      const units = parts.units[dimension] ?? {}
      const { unit } = parse(had[index])
      return write(Number(si), units, unit in units ? unit : usual, DIGITS[key])
    })
    return withValue(now, `start.${key}`, [...said, ...had.slice(said.length)] as Json)
  }, scenario)
}

/** The scenario that goes on from an instant. */
export function goneOn(scenario: Scenario, start: Table): Scenario {
  return { ...scenario, start }
}

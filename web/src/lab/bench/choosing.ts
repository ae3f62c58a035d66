/** Another body, surface, motion or load: it comes with what it needs, and keeps what both have. */
import type { Parts } from '../parts'
import type { Json, Scenario, Table } from '../scenario'

/** What the first of two tables says of these keys. */
function kept(table: Table, keys: readonly string[]): Table {
  return Object.fromEntries(keys.flatMap((key) => (table[key] === undefined ? [] : [[key, table[key]]])))
}

/** Another body: mass and radius stay between balls, the rest of its keys are its own. */
export function withBody(scenario: Scenario, kind: string, parts: Parts): Scenario {
  const chosen = parts.body[kind]
  if (!chosen?.first) return scenario
  const both = chosen.ball && (parts.body[scenario.body.kind]?.ball ?? false)
  const body = { ...chosen.first, ...(both && kept(scenario.body, ['radius', 'mass'])) }
  if (both) return { ...scenario, body }
  const said = scenario.start.velocity === 'rolling' ? ['position'] : ['position', 'velocity'] // with the Ω that goes
  const start = { position: [0, 0], ...kept(scenario.start, said), ...chosen.start }
  return { ...scenario, body, start }
}

/** Another surface: how it moves and its friction stay; the start goes to a place that the new one has. */
export function withSurface(scenario: Scenario, kind: string, parts: Parts): Scenario {
  const chosen = parts.support[kind]
  if (!chosen?.first) return scenario
  const support = { ...chosen.first, ...kept(scenario.support, ['motion', ...Object.keys(parts.common.support)]) }
  return { ...scenario, support, start: { ...chosen.start, ...kept(scenario.start, ['spin']) } }
}

/** Another motion: the rate stays where both have one. */
export function withMotion(scenario: Scenario, kind: string, parts: Parts): Scenario {
  const { motion: before, ...support } = scenario.support
  const chosen = parts.motion[kind]
  if (!chosen?.first) return scenario
  if (kind === parts.at_rest) return { ...scenario, support: support as Scenario['support'] }
  const was = parts.motion[before?.kind ?? parts.at_rest]?.rate
  const rate = was && chosen.rate && before?.[was] !== undefined ? { [chosen.rate]: before[was] } : {}
  return { ...scenario, support: { ...support, motion: { ...chosen.first, ...rate } } as Scenario['support'] }
}

/** One more load. */
export function withLoad(scenario: Scenario, kind: string, parts: Parts): Scenario {
  const load = parts.loads[kind]?.first
  return load ? { ...scenario, loads: [...(scenario.loads ?? []), load] } : scenario
}

/** The loads without one of them; no list where none is left. */
export function withLoads(scenario: Scenario, loads: Scenario['loads']): Scenario {
  const { loads: _, ...rest } = scenario
  return loads?.length ? { ...rest, loads } : rest
}

/** The table with one of its lists changed in one place; what the list is where there is none. */
export function withPart(values: Json | undefined, otherwise: Json[], index: number, value: Json): Json[] {
  return (Array.isArray(values) ? values : otherwise).map((was, place) => (place === index ? value : was))
}

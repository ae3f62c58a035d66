/** A scenario as JSON: exactly what a scenario file says, words and units kept ("33.3 rpm"). */

/** A bare number is SI; a text carries its unit. */
export type Quantity = number | string

export type Json = null | boolean | number | string | Json[] | { [key: string]: Json | undefined }
export type Table = { [key: string]: Json | undefined }

export interface Scenario {
  title?: string
  notes?: string
  gravity?: Quantity
  body: Table & { kind: string }
  support: Table & { kind: string; motion?: Table & { kind: string } }
  start: Table
  loads?: (Table & { kind: string })[]
  run: Table & { duration: Quantity; every: Quantity; method?: string }
}

/** A place in a scenario: "support.motion.rate", "start.velocity.0", "loads.1.coefficient". */
export type Path = string

type Holder = { [key: string]: Json | undefined } | Json[]

function isHolder(value: unknown): value is Holder {
  return typeof value === 'object' && value !== null
}

/** What stands at a place, or undefined. */
export function valueAt(scenario: Scenario, path: Path): Json | undefined {
  let value: unknown = scenario
  for (const key of path.split('.')) {
    if (!isHolder(value)) return undefined
    value = (value as Record<string, unknown>)[key]
  }
  return value as Json | undefined
}

/** A copy with one place changed; undefined takes the key away. Tables on the way are made where missing. */
export function withValue(scenario: Scenario, path: Path, value: Json | undefined): Scenario {
  const keys = path.split('.')
  return changed(scenario as unknown as Holder, keys, value) as unknown as Scenario
}

function changed(holder: Holder | undefined, keys: string[], value: Json | undefined): Holder {
  const [key = '', ...rest] = keys
  const copy: Holder = Array.isArray(holder)
    ? [...holder]
    : isHolder(holder)
      ? { ...holder }
      : /^\d+$/.test(key)
        ? []
        : {}
  const inner = (copy as Record<string, Json | undefined>)[key]
  const next = rest.length ? (changed(isHolder(inner) ? (inner as Holder) : undefined, rest, value) as Json) : value
  if (next === undefined && Array.isArray(copy)) copy.splice(Number(key), 1)
  else if (next === undefined) delete (copy as Table)[key]
  else (copy as Record<string, Json | undefined>)[key] = next
  return copy
}

/** The same by several places at once, in order. */
export function withValues(scenario: Scenario, changes: [Path, Json | undefined][]): Scenario {
  return changes.reduce((so, [path, value]) => withValue(so, path, value), scenario)
}

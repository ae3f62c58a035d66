/** What a map shows, as the address says it: a shipped sweep by its name, any other by its whole content. */
import type { MapRequest, ShippedSweep, Span, Sweeps } from '../../api'
import { decodeAny, encode, isScenario, LinkError } from '../../share'

/** A map that is asked for: of a shipped sweep, until something in it is changed. */
export interface Asked {
  name: string | null
  request: MapRequest
}

export function ofShipped(sweep: ShippedSweep, measure?: string): Asked {
  const measures = Object.values(sweep.measures)
  const chosen = measure !== undefined && measures.includes(measure) ? measure : (measures[0] ?? 'end-time')
  return { name: sweep.name, request: { scenario: sweep.scenario, over: sweep.over, measure: chosen } }
}

export async function paramsOf(
  { name, request }: Asked,
  at: readonly [number, number] | null,
): Promise<Record<string, string>> {
  const point: Record<string, string> = at ? { at: at.join(',') } : {}
  return name === null ? { m: await encode(request), ...point } : { name, measure: request.measure, ...point }
}

/** What an address asks for: the first of the shipped sweeps where it says nothing. Throws a LinkError. */
export async function askedBy(params: Readonly<Record<string, string>>, { sweeps }: Sweeps): Promise<Asked> {
  if (params.m) {
    const request = await decodeAny(params.m)
    if (!isRequest(request)) throw new LinkError('The link holds no map.')
    return { name: null, request }
  }
  const found = sweeps.find(({ name }) => name === params.name)
  if (params.name && !found) throw new LinkError(`There is no sweep ${params.name}.`)
  const sweep = found ?? sweeps.at(-1)
  if (!sweep) throw new LinkError('No sweep is shipped with this copy of trundle.')
  return ofShipped(sweep, params.measure)
}

/** The point of an address, "12,5". */
export function pointOf(params: Readonly<Record<string, string>>): [number, number] | null {
  const match = /^(\d{1,3}),(\d{1,3})$/.exec(params.at ?? '')
  return match ? [Number(match[1]), Number(match[2])] : null
}

function isRequest(value: unknown): value is MapRequest {
  if (typeof value !== 'object' || value === null) return false
  const { scenario, over, measure } = value as Record<string, unknown>
  const sides = Array.isArray(over) && over.length === 2 && over.every(isSpan)
  return isScenario(scenario) && sides && typeof measure === 'string'
}

function isSpan(value: unknown): value is Span {
  if (typeof value !== 'object' || value === null) return false
  const { key, from, to, count, scale } = value as Record<string, unknown>
  const quantity = (one: unknown) => typeof one === 'number' || typeof one === 'string'
  return (
    typeof key === 'string' &&
    quantity(from) &&
    quantity(to) &&
    Number.isInteger(count) &&
    (scale === 'linear' || scale === 'log')
  )
}

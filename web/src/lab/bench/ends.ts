/** Where sliders end: at the last value with which a run can start, which the package is asked. */
import type { Refused } from '../api'
import type { Json, Scenario } from '../scenario'
import type { Limit } from './field'

export interface Sliding {
  now(): Json
  /** What the slider says at a share of its length. */
  at(share: number): Json | null
  share(): number
  /** The scenario with another value. */
  with(value: Json): Scenario
}

export type Ends = Record<'low' | 'high', Limit | null>

const ROUNDS = 7 // halvings: a hundredth of a slider
const AT_ONCE = 100

interface End {
  slider: number
  side: 'low' | 'high'
  good: number
  bad: number
  /** At the good place. */
  value: Json
  why: string
}

/** The ends of several sliders; `possible` says of each scenario why it cannot start. */
export async function endsOf(
  sliders: readonly Sliding[],
  possible: (scenarios: Scenario[]) => Promise<(Refused | null)[]>,
  inWords: (message: string) => string,
): Promise<Ends[]> {
  async function asked(all: Scenario[]): Promise<(Refused | null)[]> {
    const found: (Refused | null)[] = []
    for (let from = 0; from < all.length; from += AT_ONCE)
      found.push(...(await possible(all.slice(from, from + AT_ONCE))))
    return found
  }
  let open = sliders.flatMap((slider, index): End[] => {
    if (slider.at(0) === null) return []
    const now = { slider: index, good: Math.min(1, Math.max(0, slider.share())), value: slider.now(), why: '' }
    return [
      { ...now, side: 'low', bad: 0 },
      { ...now, side: 'high', bad: 1 },
    ]
  })
  const said = ({ slider }: End, share: number) => sliders[slider]!.at(share)!
  const tried = (end: End, share: number) => sliders[end.slider]!.with(said(end, share))
  const first = await asked(open.map((end) => tried(end, end.bad)))
  open = open.flatMap((end, i) => (first[i] ? [{ ...end, why: inWords(first[i].message) }] : []))
  for (let round = 0; round < ROUNDS && open.length; round++) {
    const middles = open.map(({ good, bad }) => (good + bad) / 2)
    const answers = await asked(open.map((end, i) => tried(end, middles[i]!)))
    open = open.map((end, i) =>
      answers[i]
        ? { ...end, bad: middles[i]!, why: inWords(answers[i].message) }
        : { ...end, good: middles[i]!, value: said(end, middles[i]!) },
    )
  }
  const ends = sliders.map((): Ends => ({ low: null, high: null }))
  for (const { slider, side, value, why } of open) ends[slider]![side] = { value, why }
  return ends
}

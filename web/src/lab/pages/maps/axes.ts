/** The sides of a map: its values in the unit in which they were asked for, where they stand, and what is written there. */
import { t } from '../../../languages/translate'
import type { MapPart, Named, Span } from '../../api'
import { parse, rounded, show } from '../../quantity'

export interface Side extends Named {
  unit: string
  log: boolean
  /** Of each field, in the unit. */
  values: number[]
}

/** A place along a side, from 0 to 1, and what is written there. */
export interface Tick {
  at: number
  text: string
}

export function sideOf(axis: MapPart['axes'][number], span: Span): Side {
  const [from, to] = [parse(span.from), parse(span.to)]
  const same = from.unit !== '' && from.unit === to.unit
  const factor = same ? factorOf(axis.values, from.number, to.number) : null
  return {
    key: axis.key,
    group: axis.group,
    label: axis.label,
    unit: factor === null ? axis.unit : from.unit,
    log: span.scale === 'log',
    values: axis.values.map((value) => value * (factor ?? 1)),
  }
}

/** How many of the unit written one SI unit is. */
function factorOf(values: number[], from: number | null, to: number | null): number | null {
  const [first = 0, last = 0] = [values[0], values.at(-1)]
  if (first !== 0 && from !== null) return from / first
  return last !== 0 && to !== null ? to / last : null
}

/** Where a value stands: the middle of the first field is half a field from the edge. */
export function placeOf(side: Side, value: number): number {
  const scaled = (x: number) => (side.log ? Math.log(x) : x)
  const [first = 0, last = 1] = [side.values[0], side.values.at(-1)]
  const share = (scaled(value) - scaled(first)) / (scaled(last) - scaled(first) || 1)
  return (0.5 + share * (side.values.length - 1)) / side.values.length
}

/** The field at a place from 0 to 1. */
export function fieldAt(side: Side, at: number): number {
  return Math.max(0, Math.min(side.values.length - 1, Math.floor(at * side.values.length)))
}

export function ticksOf(side: Side, most: number): Tick[] {
  const [first = 0, last = 0] = [side.values[0], side.values.at(-1)]
  const [low, high] = [Math.min(first, last), Math.max(first, last)]
  const round = side.log ? decades(low, high, most) : roundNumbers(low, high, most)
  return round.map((value) => ({ at: placeOf(side, value), text: show(value) }))
}

/** Round numbers from the least to the largest: so many at most, steps of 1, 2 or 5. */
export function roundNumbers(low: number, high: number, most: number): number[] {
  if (!(high > low)) return [low]
  const rough = (high - low) / Math.max(most - 1, 1)
  const decade = 10 ** Math.floor(Math.log10(rough))
  const step = [1, 2, 5, 10].map((times) => times * decade).find((one) => one >= rough * (1 - 1e-9)) ?? 10 * decade
  const count = Math.floor((high - low) / step + 1e-9) + 1
  const begin = Math.ceil(low / step - 1e-9)
  return Array.from({ length: count }, (_, i) => rounded((begin + i) * step, 12)).filter(
    (value) => value <= high + step * 1e-9,
  )
}

function decades(low: number, high: number, most: number): number[] {
  for (const digits of [[1, 2, 5], [1, 3], [1]]) {
    const found: number[] = []
    for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); power += 1)
      for (const digit of digits) {
        const value = rounded(digit * 10 ** power, 12)
        if (value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9)) found.push(value)
      }
    if (found.length <= most) return found
  }
  return [low, high]
}

/** A unit as it is printed: m/s^2 as m/s². */
export function inPrint(unit: string): string {
  return unit.replace(/\^?(?<=[A-Za-z^])-?\d/g, (power) => superscript(power.replace('^', ''))).replaceAll('*', ' ')
}

function superscript(power: string): string {
  return [...power].map((c) => (c === '-' ? '⁻' : '⁰¹²³⁴⁵⁶⁷⁸⁹'[Number(c)])).join('')
}

/** What a number is called in full: "Start: Angular velocity z". */
export function nameOf({ group, label }: Named): string {
  return group ? `${t(group)}: ${t(label)}` : t(label)
}

export function labelOf(name: string, unit: string): string {
  return unit && unit !== '1' ? `${name} (${inPrint(unit)})` : name
}

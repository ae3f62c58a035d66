import { describe, expect, it } from 'vitest'
import type { Scene } from '../viewer/scene'
import { createChart, indexBefore, pathOf, ticks } from './chart'
import { csvOf, svgOf } from './curves'
import { quantitiesOf } from './series'

const look = {
  ink: '#111',
  grid: '#ddd',
  line: '#00f',
  event: '#f00',
  paper: '#fff',
  width: 2,
  font: 'monospace',
  size: 12,
}
const time = [0, 1, 2, 3]
const plot = {
  x: { label: 'Time', unit: 's', values: time },
  y: { label: 'Speed, <all>', unit: 'm/s', values: [0, 2, Number.NaN, 4] },
  time,
  events: [1.5],
}
const against = { ...plot, x: { label: 'Lean', unit: '°', values: [10, 20, 30, 10] } }

describe('ticks', () => {
  it('are round numbers within the ends', () => {
    expect(ticks(0, 1, 5)).toEqual([0, 0.2, 0.4, 0.6, 0.8, 1])
    expect(ticks(-0.013, 0.021, 3)).toEqual([0, 0.02])
    expect(ticks(1, 1, 4)).toEqual([1])
  })
})

describe('a path', () => {
  it('is broken where there is no number', () => {
    expect(pathOf([0, 1, 2, 3], [5, 6, Number.NaN, 8], true)).toBe('M0.0 5.0L1.0 6.0M3.0 8.0')
  })
  it('keeps first, last, lowest and highest of many points in one column', () => {
    const ys = [5, 9, 4, 6, 1, 7, 5]
    const xs = ys.map((_, i) => 0.1 * i)
    expect(pathOf(xs, ys, true).match(/ \d\.0/g)).toEqual([' 5.0', ' 9.0', ' 1.0', ' 5.0'])
    expect(pathOf(xs, ys, false).match(/[ML]/g)).toHaveLength(7)
  })
})

describe('a chart', () => {
  it('finds the sample next to a place: over time by time alone, else by both', () => {
    expect(createChart(plot, look, 400, 200).nearest(400, 0)).toBe(3)
    const chart = createChart(against, look, 400, 200)
    expect([chart.nearest(0, 0), chart.nearest(0, 200)]).toEqual([3, 0])
  })
  it('has no mark where there is no number', () => {
    const chart = createChart(plot, look, 400, 200)
    chart.at(2)
    expect(chart.element.querySelector('.playdot')?.getAttribute('visibility')).toBe('hidden')
    chart.at(3)
    expect(chart.element.querySelector('.playdot')?.getAttribute('visibility')).toBe('visible')
  })
  it('knows the sample before a time', () => {
    expect([-1, 0, 1.9, 2, 9].map((when) => indexBefore(time, when))).toEqual([0, 0, 1, 2, 3])
  })
})

describe('what is saved', () => {
  it('has every sample, empty where there is no number', () => {
    expect(csvOf(plot)).toBe('Time (s),"Speed, <all> (m/s)"\n0,0\n1,2\n2,\n3,4\n')
    expect(csvOf(against).split('\n')[1]).toBe('0,10,0')
  })
  it('names its axes, and nothing of a label gets out', () => {
    const text = svgOf(against, look)
    expect(text).toContain('xmlns="http://www.w3.org/2000/svg"')
    expect(text).toContain('Speed, &lt;all&gt; (m/s)')
    expect(text).toContain('Lean (°)')
    expect(text).not.toContain('play')
  })
})

describe('quantities', () => {
  it('are those of the package and those of the samples', () => {
    const scene = {
      header: { curves: [{ column: 'curve_lean', label: 'Lean', unit: '°' }] },
      columns: {
        time: Float64Array.of(0, 1),
        position: Float32Array.of(3, 4, 0, 0, 0, 1),
        curve_lean: Float32Array.of(7, 8),
      },
    } as unknown as Scene
    const found = quantitiesOf(scene)
    expect(found.map(({ id }) => id)).toEqual(['lean', 'distance', 'x', 'y', 'z', 'time'])
    expect(Array.from(found[0]!.values())).toEqual([7, 8])
    expect(Array.from(found[1]!.values())).toEqual([5, 0])
  })
})

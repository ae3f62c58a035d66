/** Without WebGL: the path from above as a drawing, and where the body is in numbers. */

import { Vector3 } from 'three'
import type { Frame } from './contract'
import { put, say } from './elements'
import { BREAK } from './lines'
import { shortNumber } from './quantities'
import type { Scene } from './scene'
import { Track } from './track'
import { pathPoints } from './trail'

const SVG = 'http://www.w3.org/2000/svg'
const COLOURS = 5

export class Fallback {
  readonly element: HTMLElement
  private readonly drawing: SVGSVGElement
  private readonly numbers: HTMLElement
  private tracks: Track[] = []
  private dots: SVGCircleElement[] = []
  private readonly place = new Vector3()

  constructor(document: Document) {
    this.element = document.createElement('div')
    this.element.className = 'tr-fallback'
    const said = document.createElement('p')
    said.textContent =
      'This browser draws no 3-D pictures (WebGL is missing or turned off). Here is the path seen along the support’s axis.'
    this.drawing = document.createElementNS(SVG, 'svg')
    this.drawing.setAttribute('role', 'img')
    put(this.drawing, 'aria-label', 'Path of the body, seen along the support’s axis')
    this.numbers = document.createElement('p')
    this.numbers.className = 'tr-numbers'
    this.element.append(said, this.drawing, this.numbers)
  }

  setScenes(scenes: readonly Scene[], frame: Frame): void {
    this.tracks = scenes.map((scene) => new Track(scene))
    const paths = scenes.map((scene) => linesOf(pathPoints(scene, frame)))
    const [left, top, width, height] = box(paths.flat(2))
    this.drawing.setAttribute('viewBox', [left, top, width, height].join(' '))
    this.drawing.replaceChildren()
    this.dots = paths.map((lines, i) => {
      for (const line of lines) this.add('polyline', i, { points: line.map(([x, y]) => `${x},${-y}`).join(' ') })
      return this.add('circle', i, { r: 0.015 * Math.max(width, height) }) as SVGCircleElement
    })
  }

  update(time: number): void {
    const said = this.tracks.map((track, i) => {
      const { x, y, z } = track.seek(time).position(this.place)
      this.dots[i]?.setAttribute('cx', String(x))
      this.dots[i]?.setAttribute('cy', String(-y))
      return `${track.scene.header.body.label}: x = ${shortNumber(x)} m, y = ${shortNumber(y)} m, z = ${shortNumber(z)} m`
    })
    say(this.numbers, said.join('; '))
  }

  private add(name: 'polyline' | 'circle', order: number, attributes: Record<string, string | number>): SVGElement {
    const made = this.drawing.ownerDocument.createElementNS(SVG, name)
    made.setAttribute('class', `tr-path tr-path-${(order % COLOURS) + 1}`)
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value))
    this.drawing.append(made)
    return made
  }
}

function linesOf(points: Float32Array): [number, number][][] {
  const lines: [number, number][][] = [[]]
  for (let i = 0; i < points.length; i += 4) {
    if (points[i + 3]! >= BREAK / 2) lines.push([])
    else lines[lines.length - 1]!.push([points[i]!, points[i + 1]!])
  }
  return lines
}

function box(points: [number, number][]): [number, number, number, number] {
  let [left, right, low, high] = [Infinity, -Infinity, Infinity, -Infinity]
  for (const [x, y] of points) {
    left = Math.min(left, x)
    right = Math.max(right, x)
    low = Math.min(low, y)
    high = Math.max(high, y)
  }
  const pad = 0.06 * Math.max(right - left, high - low, 1e-3)
  return [left - pad, -high - pad, right - left + 2 * pad, high - low + 2 * pad]
}

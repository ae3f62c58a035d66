import type { WebGLRenderer } from 'three'
import { expect, it } from 'vitest'
import { BodyModel } from './bodies'
import { packed } from './fixture'
import { unpack } from './scene'

const FINE = Uint32Array.of(0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2)
const COARSE = Uint32Array.of(0, 1, 2)

function model(columns: Record<string, { data: Uint32Array; shape: number[] }>): BodyModel {
  const corners = { data: Float32Array.of(1, 0, 0, 0, 1, 0, 0, 0, 1, -1, -1, -1), shape: [4, 3] }
  const moves = {
    time: { data: Float64Array.of(0, 1), shape: [2] },
    position: { data: new Float32Array(6), shape: [2, 3] },
    orientation: { data: Float32Array.of(1, 0, 0, 0, 1, 0, 0, 0), shape: [2, 4] },
  }
  return new BodyModel(unpack(packed({ ...moves, body_vertices: corners, body_normals: corners, ...columns })), 0)
}

/** What is drawn of a body's triangles with so many pixels to a CSS pixel. */
function drawn({ mesh }: BodyModel, ratio: number): number[] {
  const renderer = { getPixelRatio: () => ratio } as WebGLRenderer
  const draw = mesh.onBeforeRender as unknown as (renderer: WebGLRenderer) => void
  draw(renderer)
  const { start, count } = mesh.geometry.drawRange
  return [...(mesh.geometry.index!.array as Uint32Array).slice(start, start + count)]
}

it('is drawn with fewer triangles where there are fewer pixels than the screen has', () => {
  const body = model({
    body_triangles: { data: FINE, shape: [4, 3] },
    body_coarse: { data: COARSE, shape: [1, 3] },
  })
  expect(drawn(body, 1)).toEqual([...FINE])
  expect(drawn(body, 0.42)).toEqual([...COARSE])
  expect(drawn(body, 1.5)).toEqual([...FINE])
})

it('is drawn whole where it has no coarser triangles', () => {
  const body = model({ body_triangles: { data: FINE, shape: [4, 3] } })
  expect(drawn(body, 0.42)).toEqual([...FINE])
})

it('takes the vertices of one that has only grown, and leaves the scene before as it was', () => {
  const body = model({ body_triangles: { data: FINE, shape: [4, 3] } })
  const before = body.scene
  const { geometry } = body.mesh
  const larger = before.columns.body_vertices!.map((part) => 2 * part)
  body.load({ header: before.header, columns: { ...before.columns, body_vertices: larger } })
  expect(body.mesh.geometry).toBe(geometry)
  expect([...geometry.getAttribute('position').array]).toEqual([...larger])
  expect(geometry.boundingSphere!.radius).toBeGreaterThan(2)
  expect(before.columns.body_vertices![0]).toBe(1)
})

import { Group, type Mesh } from 'three'
import { expect, it } from 'vitest'
import { circling } from './fixture'
import { type Scene, unpack } from './scene'
import { SupportModel } from './support'

function onTable(rim: number | null): Scene {
  const { header, columns } = unpack(circling(3))
  const support = { ...header.support, size: 0.2, rim }
  const mesh = {
    support_vertices: Float32Array.of(0, 0, 0, 0.2, 0, 0, 0, 0.2, 0),
    support_normals: Float32Array.of(0, 0, 1, 0, 0, 1, 0, 0, 1),
    support_triangles: Uint32Array.of(0, 1, 2),
  }
  return { header: { ...header, support }, columns: { ...columns, ...mesh } }
}

function corners(rim: number | null): number {
  const root = new Group()
  new SupportModel(root).load([onTable(rim)])
  const parts = root.children[0]!.children.filter((part) => part.visible) as Mesh[]
  return Math.max(...parts.map((part) => part.geometry.getAttribute('position')?.count ?? 0))
}

it('has a side where it is shown to its rim, and only there', () => {
  expect(corners(0.2)).toBeGreaterThan(100)
  expect(corners(0.5)).toBe(3)
  expect(corners(null)).toBe(3)
})

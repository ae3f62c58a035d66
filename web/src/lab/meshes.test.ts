import { expect, it } from 'vitest'
import { packed } from '../viewer/fixture'
import { type Scene, unpack } from '../viewer/scene'
import { createMeshes } from './meshes'

const ORIGIN = { data: new Float32Array(3), shape: [1, 3] }
const TRIANGLES = { data: Uint32Array.of(0, 1, 2), shape: [1, 3] }

/** A scene with a body of one triangle, whose size is told, or without it. */
function sceneOf(name: string, size: number, sent = true): Scene {
  const vertices = { data: Float32Array.of(size, 0, 0, 0, size, 0, 0, 0, size), shape: [3, 3] }
  const normals = { data: Float32Array.of(1, 0, 0, 0, 1, 0, 0, 0, 1), shape: [3, 3] }
  const mesh = { body_vertices: vertices, body_normals: normals, body_triangles: TRIANGLES, body_pattern: normals }
  const moves = {
    time: { data: Float64Array.of(0, 1), shape: [2] },
    position: { data: new Float32Array(6), shape: [2, 3] },
  }
  return unpack(packed({ ...moves, ...(sent && mesh) }, { meshes: { body: { name, size } } }))
}

it('gives a scene the mesh that came before, in its own size', () => {
  const meshes = createMeshes()
  const first = meshes.completed(sceneOf('ball', 0.5), meshes.of(undefined))
  const known = meshes.of(first)
  expect([...known.keys()]).toEqual(['ball'])
  const moved = meshes.completed(sceneOf('ball', 0.5, false), known)
  expect(moved.columns.body_vertices).toBe(first.columns.body_vertices)
  const larger = meshes.completed(sceneOf('ball', 2, false), known)
  expect([...larger.columns.body_vertices!]).toEqual([2, 0, 0, 0, 2, 0, 0, 0, 2])
  expect(larger.columns.body_triangles).toBe(first.columns.body_triangles)
  expect([...first.columns.body_vertices!]).toEqual([0.5, 0, 0, 0, 0.5, 0, 0, 0, 0.5])
})

it('scales what was sent, not what was scaled before, so that rounding does not add up', () => {
  const meshes = createMeshes()
  const first = meshes.completed(sceneOf('ball', 0.1), meshes.of(undefined))
  let scene = first
  for (let i = 1; i < 2000; i++) scene = meshes.completed(sceneOf('ball', 0.1 + i / 7000, false), meshes.of(scene))
  const again = meshes.completed(sceneOf('ball', 0.1, false), meshes.of(scene))
  expect(again.columns.body_vertices).toBe(first.columns.body_vertices)
})

it('knows no mesh of a scene that names none, and forgets what was met long ago', () => {
  const meshes = createMeshes()
  const first = meshes.completed(sceneOf('0', 1), new Map())
  const known = meshes.of(first)
  for (let i = 1; i < 100; i++) meshes.completed(sceneOf(`${i}`, 1), new Map())
  expect([...meshes.of(first)]).toEqual([])
  // What was asked for before it was forgotten can still be completed.
  expect(meshes.completed(sceneOf('0', 1, false), known).columns.body_vertices).toHaveLength(9)
  const unnamed = unpack(packed({ time: { data: Float64Array.of(0), shape: [1] }, position: ORIGIN }))
  expect([...meshes.of(unnamed)]).toEqual([])
  expect(meshes.completed(unnamed, known).columns).toEqual(unnamed.columns)
})

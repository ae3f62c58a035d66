import { expect, test } from 'vitest'
import { circling, packed } from './fixture'
import { unpack } from './scene'

test('header and columns come out as they went in', () => {
  const scene = unpack(circling(5))
  expect(scene.header.title).toBe('Ball in a circle, Ω')
  expect([...scene.columns.time]).toEqual([0, 0.5, 1, 1.5, 2])
  expect(scene.columns.position[3]).toBeCloseTo(Math.cos(0.5), 6)
  expect(scene.columns.phase).toBeInstanceOf(Uint8Array)
  expect(scene.columns.guiding_centre).toBeUndefined()
})

test('bytes may lie anywhere in a buffer, as those of a notebook’s message do', () => {
  const blob = circling(3)
  const askew = new Uint8Array(blob.length + 3)
  askew.set(blob, 3)
  const view = new DataView(askew.buffer, 3, blob.length)
  expect([...unpack(view).columns.position]).toEqual([...unpack(blob.buffer as ArrayBuffer).columns.position])
})

test('columns stand one behind the other, whatever their types', () => {
  const scene = unpack(
    packed({
      phase: { data: Uint8Array.of(2, 1, 0), shape: [3] },
      time: { data: Float64Array.of(0, 0.1, 0.2), shape: [3] },
      position: { data: new Float32Array(9).fill(7), shape: [3, 3] },
    }),
  )
  expect([...scene.columns.time]).toEqual([0, 0.1, 0.2])
  expect([...(scene.columns.phase ?? [])]).toEqual([2, 1, 0])
})

test('any number comes as it was, to the bit', () => {
  const odd = [-0, 5e-324, -1.7976931348623157e308, Number.POSITIVE_INFINITY, Number.NaN, 0.1, -0.1]
  const scene = unpack(
    packed({
      time: { data: Float64Array.from(odd), shape: [7] },
      position: { data: Float32Array.from(odd.flatMap((one) => [one, -one, 1])), shape: [7, 3] },
      phase: { data: Uint8Array.of(0, 255, 0, 255, 255, 1, 0), shape: [7] },
      body_triangles: { data: Uint32Array.of(4294967295, 0, 7, 1, 4294967295, 0), shape: [2, 3] },
    }),
  )
  expect([...scene.columns.time]).toEqual(odd)
  expect([...scene.columns.position]).toEqual([...Float32Array.from(odd.flatMap((one) => [one, -one, 1]))])
  expect([...scene.columns.phase!]).toEqual([0, 255, 0, 255, 255, 1, 0])
  expect([...scene.columns.body_triangles!]).toEqual([4294967295, 0, 7, 1, 4294967295, 0])
})

test('what is no scene, or only part of one, is refused', () => {
  const blob = circling(4)
  expect(() => unpack(new Uint8Array(4))).toThrow(/begins with TRUNDLE1/)
  expect(() => unpack(blob.slice(0, 40))).toThrow(/within its header/)
  expect(() => unpack(blob.slice(0, blob.length - 1))).toThrow(/support_orientation ends at byte/)
  expect(() => unpack(packed({ time: { data: Float64Array.of(0), shape: [1] } }))).toThrow(/time and position/)
  const newer = packed({ time: { data: Float64Array.of(0), shape: [1] } }, { format: 4 })
  expect(() => unpack(newer)).toThrow(/format 3; got 4/)
})

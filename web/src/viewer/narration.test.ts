import { expect, test } from 'vitest'
import { circling, packed } from './fixture'
import { described, narrated } from './narration'
import type { SceneHeader } from './scene'
import { unpack } from './scene'

const bytes = (scene: Uint8Array) => scene.slice().buffer

/** A ball on a line through the axis: x and the velocity along x as they are given, one a second. */
function along(x: number[], v: number[], header: Partial<SceneHeader> = {}, phase = 0) {
  const n = x.length
  return unpack(
    bytes(
      packed(
        {
          time: { data: Float64Array.from(x, (_, i) => i), shape: [n] },
          position: { data: Float32Array.from(x.flatMap((one) => [one, 0, 0.1])), shape: [n, 3] },
          velocity: { data: Float32Array.from(v.flatMap((one) => [one, 0, 0])), shape: [n, 3] },
          phase: { data: new Uint8Array(n).fill(phase), shape: [n] },
        },
        header,
      ),
    ),
  )
}

test('a ball that goes out and slows is said so', () => {
  const scene = along([0.02, 0.12, 0.18], [0.1, 0.08, 0.04])
  expect(described(scene, 1)).toBe('12 cm from the axis, moving outwards, slowing')
  expect(narrated([scene], 1)).toBe('1.0 s: ball 12 cm from the axis, moving outwards, slowing.')
})

test('inwards, faster, slipping; and at rest', () => {
  expect(described(along([2.34, 2, 1], [-0.2, -0.5, -1], {}, 1), 1)).toBe(
    '2 m from the axis, moving inwards, getting faster, slipping',
  )
  expect(described(along([0.005, 0.005], [0, 0]), 0.5)).toBe('5 mm from the axis, at rest')
})

test('what moves is called by the noun of its scene; one kept from before has none', () => {
  const { noun: _, ...body } = along([0], [0]).header.body
  const said = (more: object) => narrated([along([1, 1], [0, 0], { body: { ...body, ...more } })], 0)
  expect(said({ noun: 'disc', ball: false })).toContain('disc 1 m from the axis')
  expect(said({ noun: 'charge' })).toContain('charge 1 m')
  expect(said({})).toContain('body 1 m')
})

test('round the axis, the way round is said', () => {
  expect(described(unpack(bytes(circling(101))), 1)).toBe(
    '1 m from the axis, going round anticlockwise, at an even speed',
  )
})

test('where there is no axis it is told from the start', () => {
  const support = { ...along([0], [0]).header.support, moves: false, rim: null }
  const scene = along([0.5, 0.6, 0.7], [0.1, 0.1, 0.1], { support })
  expect(described(scene, 0)).toContain('where it began')
  expect(described(scene, 2)).toBe('20 cm from where it began, moving away, at an even speed')
})

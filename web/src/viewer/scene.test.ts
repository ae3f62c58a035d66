import { expect, test } from 'vitest'
import { unpack } from './scene'

test('what is not a scene is refused', () => {
  expect(() => unpack(new Uint8Array(4))).toThrow()
})

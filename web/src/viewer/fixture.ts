/** Scenes for the tests, packed by hand as docs and package say, so that reading is tested against something else. */
import type { SceneHeader } from './scene'

type Data = Float32Array | Float64Array | Uint32Array | Uint8Array

const NAMES = new Map<unknown, string>([
  [Float32Array, 'float32'],
  [Float64Array, 'float64'],
  [Uint32Array, 'uint32'],
  [Uint8Array, 'uint8'],
])

export function packed(
  columns: Record<string, { data: Data; shape: number[] }>,
  header: Partial<SceneHeader> = {},
): Uint8Array {
  const described: Record<string, unknown> = {}
  let offset = 0
  for (const [name, { data, shape }] of Object.entries(columns)) {
    described[name] = { dtype: NAMES.get(data.constructor), shape, offset, unit: 'm' }
    offset += data.byteLength
  }
  const head = new TextEncoder().encode(JSON.stringify({ ...HEADER, ...header, columns: described }))
  const blob = new Uint8Array(16 + head.length + offset)
  blob.set(new TextEncoder().encode('TRUNDLE1'))
  new DataView(blob.buffer).setUint32(8, head.length, true)
  blob.set(head, 16)
  let at = 16 + head.length
  for (const { data, shape } of Object.values(columns)) {
    const bytes = differences(data, data.length / (shape[0] ?? 1))
    const width = bytes.length / (shape[0] ?? 1)
    bytes.forEach((byte, i) => {
      blob[at + (i % width) * (shape[0] ?? 1) + Math.floor(i / width)] = byte
    })
    at += bytes.length
  }
  return blob
}

/** The bytes of each number less twice that of the row before and plus that of the row before that, as integers. */
function differences(data: Data, side: number): Uint8Array {
  const bits = 8 * data.BYTES_PER_ELEMENT
  const old = new DataView(data.buffer, data.byteOffset, data.byteLength)
  const word = (i: number) => {
    let whole = 0n
    for (let byte = data.BYTES_PER_ELEMENT - 1; byte >= 0 && i >= 0; byte--)
      whole = 256n * whole + BigInt(old.getUint8(i * data.BYTES_PER_ELEMENT + byte))
    return whole
  }
  return Uint8Array.from(
    Array.from(data, (_, i) => BigInt.asUintN(bits, word(i) - 2n * word(i - side) + word(i - 2 * side))).flatMap(
      (one) => Array.from({ length: data.BYTES_PER_ELEMENT }, (_, byte) => Number((one >> BigInt(8 * byte)) & 255n)),
    ),
  )
}

const HEADER = {
  format: 3,
  title: 'Ball in a circle, Ω',
  method: 'exact',
  tolerance: 0,
  duration: 2,
  gravity: [0, 0, -9.81],
  tilt: 0,
  to_world: [1, 0, 0, 0],
  body: {
    kind: 'solid-sphere',
    radius: 0.1,
    name: 'Solid sphere',
    mass: 0.5,
    label: 'Solid sphere, k = 2/5',
    noun: 'ball',
    ball: true,
  },
  support: {
    kind: 'plane',
    name: 'Turning plane',
    flat: true,
    deep: false,
    moves: true,
    size: 1,
    marks: 'polar',
    rim: 1,
    friction: 0.3,
  },
  events: [],
}

/** A ball that runs round a circle of radius 1 at rate 1 while the table turns at rate `turn`, in n samples over 2 s. */
export function circling(n: number, turn = 1.5): Uint8Array {
  const time = Float64Array.from({ length: n }, (_, i) => (2 * i) / (n - 1))
  const rows = (of: (t: number) => number[]) => Float32Array.from(Array.from(time, of).flat())
  return packed({
    time: { data: time, shape: [n] },
    position: { data: rows((t) => [Math.cos(t), Math.sin(t), 0.1]), shape: [n, 3] },
    contact: { data: rows((t) => [Math.cos(t), Math.sin(t), 0]), shape: [n, 3] },
    velocity: { data: rows((t) => [-Math.sin(t), Math.cos(t), 0]), shape: [n, 3] },
    orientation: { data: rows((t) => [Math.cos(t / 2), 0, 0, Math.sin(t / 2)]), shape: [n, 4] },
    phase: { data: new Uint8Array(n), shape: [n] },
    support_position: { data: new Float32Array(3 * n), shape: [n, 3] },
    support_orientation: {
      data: rows((t) => [Math.cos((turn * t) / 2), 0, 0, Math.sin((turn * t) / 2)]),
      shape: [n, 4],
    },
  })
}

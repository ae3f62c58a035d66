/** The edges of a mesh: sides that belong to one triangle only, joined to lines. */

export function edgesOf(vertices: Float32Array, triangles: Uint32Array): number[][] {
  const same = welded(vertices)
  const sides = new Map<number, [number, number] | null>()
  const count = vertices.length / 3
  for (let t = 0; t < triangles.length; t += 3) {
    for (let k = 0; k < 3; k++) {
      const [a, b] = [same[triangles[t + k]!]!, same[triangles[t + ((k + 1) % 3)]!]!]
      if (a === b) continue
      const key = a < b ? a * count + b : b * count + a
      sides.set(key, sides.has(key) ? null : [a, b])
    }
  }
  const next = new Map<number, number>()
  for (const side of sides.values()) if (side) next.set(side[0], side[1])
  return chained(next).map((line) => line.flatMap((i) => [...vertices.subarray(3 * i, 3 * i + 3)]))
}

/** For each vertex, the first one at the same place: a seam has two. */
function welded(vertices: Float32Array): Uint32Array {
  let size = 0
  for (const value of vertices) size = Math.max(size, Math.abs(value))
  const step = size * 1e-5 || 1
  const first = new Map<string, number>()
  const same = new Uint32Array(vertices.length / 3)
  for (let i = 0; i < same.length; i++) {
    const key = [0, 1, 2].map((axis) => Math.round(vertices[3 * i + axis]! / step)).join(' ')
    const known = first.get(key)
    if (known === undefined) first.set(key, i)
    same[i] = known ?? i
  }
  return same
}

function chained(next: Map<number, number>): number[][] {
  const lines: number[][] = []
  const ends = new Set(next.values())
  const starts = [...[...next.keys()].filter((i) => !ends.has(i)), ...next.keys()]
  for (const start of starts) {
    const line = [start]
    for (let i = next.get(start); i !== undefined; i = next.get(i)) {
      next.delete(line[line.length - 1]!)
      line.push(i)
    }
    if (line.length > 1) lines.push(line)
  }
  return lines
}

/** Meshes that came before: what only moves otherwise, or is only larger, is not sent again. */
import type { Columns, Scene } from '../viewer/scene'

const MOST = 24
const PARTS = {
  body: ['body_vertices', 'body_normals', 'body_triangles', 'body_pattern', 'body_coarse'],
  support: ['support_vertices', 'support_normals', 'support_triangles', 'support_marks'],
} as const

type Whose = keyof typeof PARTS

/** A mesh as it was sent. */
interface Mesh {
  readonly parts: Partial<Columns>
  readonly size: number
}

type Known = ReadonlyMap<string, Mesh>

export interface Meshes {
  /** Those of a scene, by name: who asks for another run says that they are here. */
  of(scene: Scene | undefined): Known
  /** A scene with the meshes that it left out. */
  completed(scene: Scene, known: Known): Scene
}

export function createMeshes(): Meshes {
  /** The one that was met last stands last. */
  const kept = new Map<string, Mesh>()

  function keep(name: string, mesh: Mesh): void {
    kept.delete(name)
    kept.set(name, mesh)
    const eldest = kept.keys().next()
    if (kept.size > MOST && !eldest.done) kept.delete(eldest.value)
  }

  return {
    of(scene) {
      const named = Object.values(scene?.header.meshes ?? {})
      return new Map(named.flatMap(({ name }) => (kept.has(name) ? [[name, kept.get(name)!]] : [])))
    },
    completed(scene, known) {
      let columns: Columns = scene.columns
      for (const whose of ['body', 'support'] as const) {
        const wanted = scene.header.meshes?.[whose]
        if (!wanted) continue
        const mesh = known.get(wanted.name) ?? { parts: partsOf(scene, whose), size: wanted.size }
        keep(wanted.name, mesh)
        columns = { ...columns, ...inSize(mesh, whose, wanted.size) }
      }
      return { header: scene.header, columns }
    },
  }
}

function partsOf({ columns }: Scene, whose: Whose): Partial<Columns> {
  return Object.fromEntries(PARTS[whose].map((part) => [part, columns[part]]))
}

/** In another size only the vertices are others. */
function inSize({ parts, size }: Mesh, whose: Whose, wanted: number): Partial<Columns> {
  const vertices = PARTS[whose][0]
  return size === wanted ? parts : { ...parts, [vertices]: parts[vertices]?.map((part) => part * (wanted / size)) }
}

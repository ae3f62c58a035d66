/** Whether shadows fall otherwise than when they were last asked about: to work them out again draws every body once more. */
import type { BufferAttribute, DirectionalLight, Mesh, Object3D } from 'three'

export class ShadowWatch {
  private known: number[] = []

  /** Whether what casts shadows, or the light, is not as it was. */
  moved(scene: Object3D, light: DirectionalLight): boolean {
    scene.updateMatrixWorld()
    const now = [...light.matrixWorld.elements, ...light.target.matrixWorld.elements]
    scene.traverseVisible((part) => {
      if (!part.castShadow || part === light) return
      const { geometry } = part as Mesh
      const place = geometry.getAttribute('position') as BufferAttribute | undefined
      now.push(geometry.id, place?.version ?? 0, ...part.matrixWorld.elements)
    })
    const same = now.length === this.known.length && now.every((value, i) => value === this.known[i])
    this.known = now
    return !same
  }

  /** What was worked out is lost. */
  forget(): void {
    this.known = []
  }
}

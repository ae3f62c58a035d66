/** A pin through a body's poles: where these point is seen also while they are turned away. */
import { CylinderGeometry, Group, Mesh, MeshStandardMaterial, SphereGeometry } from 'three'
import type { Palette } from './theme'

const SHAFT = new CylinderGeometry(0.045, 0.045, 3.1, 16).rotateX(Math.PI / 2)
const HEAD = new SphereGeometry(0.13, 24, 16).translate(0, 0, 1.55)

export class Pin {
  readonly group = new Group()
  private readonly shaft = new MeshStandardMaterial({ roughness: 0.5 })
  private readonly head = new MeshStandardMaterial({ roughness: 0.5 })

  constructor() {
    this.group.add(new Mesh(SHAFT, this.shaft), new Mesh(HEAD, this.head))
    for (const mesh of this.group.children) mesh.castShadow = true
  }

  look({ body }: Palette): void {
    this.shaft.color.set(body.ink)
    this.head.color.set(body.pole)
  }

  dispose(): void {
    this.shaft.dispose()
    this.head.dispose()
  }
}

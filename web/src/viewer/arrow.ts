/** One arrow: a round shaft with a head, of a thickness that does not change with its length. */
import { ConeGeometry, CylinderGeometry, Group, Mesh, MeshLambertMaterial, Vector3 } from 'three'

const UP = new Vector3(0, 1, 0)
const SHAFT = new CylinderGeometry(1, 1, 1, 20).translate(0, 0.5, 0)
const HEAD = new ConeGeometry(1, 1, 28).translate(0, 0.5, 0)
const direction = new Vector3()

export class Arrow {
  readonly group = new Group()
  readonly tip = new Vector3()
  private readonly material = new MeshLambertMaterial({ depthTest: false, depthWrite: false, transparent: true })
  private readonly shaft = new Mesh(SHAFT, this.material)
  private readonly head = new Mesh(HEAD, this.material)

  constructor(order: number) {
    this.group.add(this.shaft, this.head)
    this.shaft.renderOrder = order
    this.head.renderOrder = order + 0.5
    this.group.visible = false
  }

  look(colour: string): void {
    this.material.color.set(colour)
    this.material.emissive.set(colour).multiplyScalar(0.35)
  }

  /** Draw it from a place along a vector; `thick` is the radius of the shaft, all in the units of the parent. */
  set(from: Vector3, vector: Vector3, thick: number): void {
    const length = vector.length()
    this.tip.copy(from).add(vector)
    this.group.visible = length > 0.5 * thick
    if (!this.group.visible) return
    this.group.position.copy(from)
    this.group.quaternion.setFromUnitVectors(UP, direction.copy(vector).divideScalar(length))
    const head = Math.min(6 * thick, 0.6 * length)
    this.shaft.scale.set(thick, Math.max(length - head, 1e-9), thick)
    this.head.scale.set(head / 2.4, head, head / 2.4)
    this.head.position.set(0, length - head, 0)
  }

  hide(): void {
    this.group.visible = false
  }

  dispose(): void {
    this.group.removeFromParent()
    this.material.dispose()
  }
}

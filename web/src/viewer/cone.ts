/** The friction cone at a contact: the force that keeps the body rolling must lie within it. */
import { ConeGeometry, DoubleSide, Group, Mesh, MeshBasicMaterial, Vector3 } from 'three'
import type { Palette } from './theme'

const AXIS = new Vector3(0, 1, 0)
const CONE = new ConeGeometry(1, 1, 64, 1, true).rotateX(Math.PI).translate(0, 0.5, 0)

export class FrictionCone {
  readonly group = new Group()
  private readonly material = new MeshBasicMaterial({
    transparent: true,
    opacity: 0.26,
    side: DoubleSide,
    depthWrite: false,
  })
  private within = '#56b4e9'
  private broken = '#d55e00'

  constructor() {
    const mesh = new Mesh(CONE, this.material)
    mesh.renderOrder = 10
    this.group.add(mesh)
    this.group.visible = false
  }

  look({ arrows }: Palette): void {
    this.within = arrows.cone
    this.broken = arrows.broken
  }

  /** Draw it about the normal `up`, so high; `force` null takes it away. */
  update(force: Vector3 | null, contact: Vector3, up: Vector3, friction: number, height: number): void {
    this.group.visible = force !== null
    if (!force) return
    this.group.position.copy(contact)
    this.group.quaternion.setFromUnitVectors(AXIS, up)
    // A large coefficient makes a flat, wide cone: keep its slope as long as the height asked for.
    const slope = Math.hypot(1, friction)
    this.group.scale.set((friction / slope) * height, height / slope, (friction / slope) * height)
    this.material.color.set(within(force, up, friction) ? this.within : this.broken)
  }

  dispose(): void {
    this.group.removeFromParent()
    this.material.dispose()
  }
}

/** Whether a force lies within the cone about a normal, not upon it: a sliding body's force lies upon it. */
export function within(force: Vector3, normal: Vector3, friction: number): boolean {
  const pressing = force.dot(normal)
  const across = Math.sqrt(Math.max(force.lengthSq() - pressing * pressing, 0))
  return across <= friction * pressing * (1 - 1e-4)
}

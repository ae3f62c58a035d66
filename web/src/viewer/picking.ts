/** From the pointer to places on the support, and back to what was meant by a gesture. */
import { BackSide, Matrix4, type Mesh, type Object3D, Plane, Ray, Raycaster, Vector2, Vector3 } from 'three'
import type { Stage } from './stage'

/** What picking needs of a stage. */
export type View = Pick<Stage, 'width' | 'height' | 'camera' | 'root'>

/** A place of the support frame, m, and the support's normal there, on the side of the body. */
export interface Hit {
  place: Vector3
  normal: Vector3
}

const caster = new Raycaster()
const point = new Vector2()

/** Where the pointer's ray meets the support, in the support frame, m: its mesh, or else a plane through `height`. */
export function pickSupport(stage: View, surface: Object3D | null, x: number, y: number, height = 0): Vector3 | null {
  aim(stage, x, y)
  const hit = surface ? caster.intersectObject(surface, false)[0] : undefined
  if (hit) return stage.root.worldToLocal(hit.point.clone())
  return onPlane(supportRay(stage), height)
}

/** Where the pointer's ray meets a mesh, nearest to a place of the support frame; null where it passes it by. */
export function pickNear(stage: View, mesh: Mesh, x: number, y: number, near: Vector3): Hit | null {
  aim(stage, x, y)
  let [found, least]: [Hit | null, number] = [null, Infinity]
  for (const { point: at, normal, face } of caster.intersectObject(mesh, false)) {
    const place = stage.root.worldToLocal(at.clone())
    const off = place.distanceToSquared(near)
    if (off >= least) continue
    const own = (normal ?? face?.normal ?? new Vector3(0, 0, 1)).clone()
    // Told as it looks from the camera; a sheet seen from behind has its body on the other side.
    if (isBack(mesh)) own.negate()
    own.transformDirection(new Matrix4().copy(stage.root.matrixWorld).invert().multiply(mesh.matrixWorld))
    ;[found, least] = [{ place, normal: own }, off]
  }
  return found
}

const isBack = ({ material }: Mesh): boolean => !Array.isArray(material) && material.side === BackSide

/** The side of a sheet that is seen under the pointer where something lies on it: from within a bowl, or through its glass. */
export function sideAt(stage: View, sides: readonly Mesh[], x: number, y: number, place: Vector3): Mesh | null {
  let [found, least]: [Mesh | null, number] = [null, Infinity]
  for (const side of sides) {
    const off = pickNear(stage, side, x, y, place)?.place.distanceTo(place) ?? Infinity
    if (off < 0.9 * least) [found, least] = [side, off]
  }
  return found
}

function aim(stage: View, x: number, y: number): void {
  point.set((x / stage.width) * 2 - 1, 1 - (y / stage.height) * 2)
  caster.setFromCamera(point, stage.camera)
}

function supportRay(stage: View): Ray {
  return new Ray().copy(caster.ray).applyMatrix4(new Matrix4().copy(stage.root.matrixWorld).invert())
}

/** Where a ray of the support frame meets the plane z = height; null where it goes away from it or along it. */
export function onPlane(ray: Ray, height: number): Vector3 | null {
  return ray.intersectPlane(new Plane(new Vector3(0, 0, 1), -height), new Vector3())
}

/** Where the pointer's ray meets the plane through a place with a normal, all in the support frame. */
export function pickPlane(stage: View, x: number, y: number, place: Vector3, normal: Vector3): Vector3 | null {
  aim(stage, x, y)
  const plane = new Plane().setFromNormalAndCoplanarPoint(normal, place)
  return supportRay(stage).intersectPlane(plane, new Vector3())
}

/** The velocity that an arrow of this length stands for; one shorter than the least is none. */
export function drawnVelocity(from: Vector3, to: Vector3, metresPerUnit: number, least: number): Vector3 {
  const way = to.clone().sub(from)
  return way.length() < least ? way.set(0, 0, 0) : way.divideScalar(metresPerUnit)
}

/** Points of a hand-drawn curve, none nearer than `step` to the one before. */
export class Stroke {
  readonly points: Vector3[] = []

  constructor(private readonly step: number) {}

  add(place: Vector3): boolean {
    const last = this.points[this.points.length - 1]
    if (last && last.distanceTo(place) < this.step) return false
    this.points.push(place.clone())
    return true
  }
}

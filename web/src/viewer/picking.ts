/** From the pointer to places on the support, and back to what was meant by a gesture. */
import { Matrix4, type Object3D, Plane, Ray, Raycaster, Vector2, Vector3 } from 'three'
import type { Stage } from './stage'

const caster = new Raycaster()
const point = new Vector2()

/** Where the pointer's ray meets the support, in the support frame, m: its mesh, or else a plane through `height`. */
export function pickSupport(stage: Stage, surface: Object3D | null, x: number, y: number, height = 0): Vector3 | null {
  aim(stage, x, y)
  const hit = surface ? caster.intersectObject(surface, false)[0] : undefined
  if (hit) return stage.root.worldToLocal(hit.point.clone())
  return onPlane(supportRay(stage), height)
}

function aim(stage: Stage, x: number, y: number): void {
  point.set((x / stage.width) * 2 - 1, 1 - (y / stage.height) * 2)
  caster.setFromCamera(point, stage.camera)
}

function supportRay(stage: Stage): Ray {
  return new Ray().copy(caster.ray).applyMatrix4(new Matrix4().copy(stage.root.matrixWorld).invert())
}

/** Where a ray of the support frame meets the plane z = height; null where it goes away from it or along it. */
export function onPlane(ray: Ray, height: number): Vector3 | null {
  return ray.intersectPlane(new Plane(new Vector3(0, 0, 1), -height), new Vector3())
}

/** Where the pointer's ray meets the plane through a place with a normal, all in the support frame. */
export function pickPlane(stage: Stage, x: number, y: number, place: Vector3, normal: Vector3): Vector3 | null {
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

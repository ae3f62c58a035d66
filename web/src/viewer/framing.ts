/** What of a scene the camera should see, and from where. */
import { Vector3 } from 'three'
import type { Frame } from './contract'
import { newPose, type Pose, seen, viewOf } from './frames'
import type { Scene } from './scene'
import { Track } from './track'

const MOST_POINTS = 400

/** Places of the shown frame, m, that hold the support and the paths. */
export function placesToShow(scenes: readonly Scene[], frame: Frame): Vector3[] {
  const [first] = scenes
  const found: Vector3[] = []
  if (!first) return found
  const at = poses(first, frame)
  const { flat, rim } = first.header.support
  const vertices = first.columns.support_vertices
  if (vertices && !(flat && rim === null && !polar(first))) {
    const step = 3 * Math.max(1, Math.floor(vertices.length / 3 / MOST_POINTS))
    const { material, view } = at(first.columns.time[0]!)
    for (let i = 0; i + 2 < vertices.length; i += step) {
      found.push(seen(view, seen(material, new Vector3().fromArray(vertices, i))))
    }
  }
  return [...found, ...pathPlaces(scenes, frame)]
}

/** Those that hold the paths alone. */
export function pathPlaces(scenes: readonly Scene[], frame: Frame): Vector3[] {
  const [first] = scenes
  if (!first) return []
  const at = poses(first, frame)
  return scenes.flatMap((scene) => bodyPlaces(scene, at))
}

function polar({ header }: Scene): boolean {
  return header.support.marks === 'polar'
}

function bodyPlaces(scene: Scene, at: (time: number) => { view: Pose }): Vector3[] {
  const { time, position } = scene.columns
  const { radius } = scene.header.body
  const found: Vector3[] = []
  const step = Math.max(1, Math.floor(time.length / MOST_POINTS))
  for (let i = 0; i < time.length; i += step) {
    const place = seen(at(time[i]!).view, new Vector3().fromArray(position, 3 * i))
    if (!Number.isFinite(place.x + place.y + place.z)) continue
    for (const side of [-1.3, 1.3]) {
      found.push(place.clone().addScalar(side * radius))
      found.push(place.clone().add(new Vector3(side, -side, side).multiplyScalar(radius)))
    }
  }
  return found
}

/** The support's pose, and the map into the shown frame, at a time. */
function poses(scene: Scene, frame: Frame): (time: number) => { material: Pose; view: Pose } {
  const track = new Track(scene)
  const [material, view] = [newPose(), newPose()]
  return (time) => {
    track.seek(time)
    track.supportOrientation(material.turn)
    track.supportPosition(material.place)
    viewOf(frame, scene.header.to_world, material, view)
    return { material, view }
  }
}

/** From where, of the shown frame: over the shoulder; steeply into what is deep; along a pipe that lies. */
export function directionFor(scene: Scene, frame: Frame): Vector3 {
  const [w, x, y, z] = scene.header.to_world
  const axis = new Vector3(2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y))
  if (frame === 'world' && Math.abs(axis.z) < 0.5)
    return axis.multiplyScalar(Math.sign(axis.x) || 1).add(new Vector3(0.1, -0.55, 0.42))
  if (scene.header.support.deep) return new Vector3(0.3, -1, 0.85)
  return new Vector3(0.28, -1, 0.66)
}

/** How large what is shown is, m: half the largest extent. */
export function extent(places: readonly Vector3[]): number {
  const low = new Vector3(Infinity, Infinity, Infinity)
  const high = new Vector3(-Infinity, -Infinity, -Infinity)
  for (const place of places) {
    low.min(place)
    high.max(place)
  }
  const size = high.sub(low)
  return Math.max(size.x, size.y, size.z) / 2 || 1
}

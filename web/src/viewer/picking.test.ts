import { BackSide, FrontSide, Group, Mesh, MeshBasicMaterial, PerspectiveCamera, SphereGeometry, Vector3 } from 'three'
import { expect, test } from 'vitest'
import { pickNear, sideAt, type View } from './picking'

/** The lower half of a sphere of radius 1 about (0, 0, 1), its normals inwards: a bowl; seen from a place. */
function bowlFrom(eye: Vector3) {
  const half = new SphereGeometry(1, 128, 64, 0, 2 * Math.PI, Math.PI / 2, Math.PI / 2).rotateX(Math.PI / 2)
  const geometry = half.scale(-1, 1, 1).translate(0, 0, 1)
  const normal = geometry.getAttribute('normal')
  const place = geometry.getAttribute('position')
  for (let i = 0; i < normal.count; i++) normal.setXYZ(i, -place.getX(i), -place.getY(i), 1 - place.getZ(i))
  const sides = [FrontSide, BackSide].map((side) => new Mesh(geometry, new MeshBasicMaterial({ side })))
  const [root, camera] = [new Group(), new PerspectiveCamera(30, 1, 0.01, 60)]
  root.add(...sides)
  root.scale.setScalar(0.5)
  root.updateMatrixWorld(true)
  camera.up.set(0, 0, 1)
  camera.position.copy(eye)
  camera.lookAt(0, 0, 0.25)
  camera.updateMatrixWorld(true)
  const view: View = { width: 400, height: 400, camera, root }
  const seen = (place: Vector3): [number, number] => {
    const at = root.localToWorld(place.clone()).project(camera)
    return [(at.x * 0.5 + 0.5) * 400, (0.5 - at.y * 0.5) * 400]
  }
  return { view, front: sides[0]!, back: sides[1]!, sides, seen }
}

const on = (angle: number, round: number) =>
  new Vector3(Math.sin(angle) * Math.cos(round), Math.sin(angle) * Math.sin(round), 1 - Math.cos(angle))

test('a place in a bowl is found where it is seen, with the normal towards the middle', () => {
  const { view, front, sides, seen } = bowlFrom(new Vector3(0, -2, 2))
  const place = on(0.8, 1.2)
  expect(sideAt(view, sides, ...seen(place), place)).toBe(front)
  const hit = pickNear(view, front, ...seen(place), place)!
  expect(hit.place.distanceTo(place)).toBeLessThan(2e-3)
  expect(hit.normal.dot(new Vector3(0, 0, 1).sub(place))).toBeGreaterThan(0.999)
})

test('what lies behind the glass of the near wall is held there, its normal still inwards', () => {
  const { view, back, sides, seen } = bowlFrom(new Vector3(0, -3, 0.6))
  const place = on(1.2, -Math.PI / 2)
  expect(sideAt(view, sides, ...seen(place), place)).toBe(back)
  const hit = pickNear(view, back, ...seen(place), place)!
  expect(hit.place.distanceTo(place)).toBeLessThan(2e-3)
  expect(hit.normal.dot(new Vector3(0, 0, 1).sub(place))).toBeGreaterThan(0.999)
})

test('a pointer beside the bowl meets nothing', () => {
  const { view, front } = bowlFrom(new Vector3(0, -2, 2))
  expect(pickNear(view, front, 2, 2, new Vector3())).toBeNull()
})

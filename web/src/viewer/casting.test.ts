import { BoxGeometry, DirectionalLight, Group, Mesh, Scene } from 'three'
import { beforeEach, expect, test } from 'vitest'
import { ShadowWatch } from './casting'

const light = new DirectionalLight()
let scene: Scene
let turned: Group
let body: Mesh
let watch: ShadowWatch

beforeEach(() => {
  scene = new Scene()
  turned = new Group()
  body = new Mesh(new BoxGeometry())
  body.castShadow = true
  turned.add(body)
  scene.add(turned, light, light.target)
  watch = new ShadowWatch()
  watch.moved(scene, light)
})

test('shadows stay where nothing moves that casts one', () => {
  const still = new Mesh(new BoxGeometry())
  scene.add(still)
  still.position.x = 1
  expect(watch.moved(scene, light)).toBe(false)
})

test.each([
  ['a body moves', () => body.position.setX(1)],
  ['what carries it turns', () => turned.rotateZ(1)],
  ['it takes another shape', () => Object.assign(body, { geometry: new BoxGeometry() })],
  ['it grows', () => Object.assign(body.geometry.getAttribute('position'), { needsUpdate: true })],
  ['it vanishes', () => Object.assign(body, { visible: false })],
  ['all is forgotten', () => watch.forget()],
  ['the light moves', () => light.position.setX(light.position.x + 3)],
  ['the light shines elsewhere', () => light.target.position.setX(light.target.position.x + 2)],
])('they fall otherwise where %s, once', (_, change) => {
  change()
  expect(watch.moved(scene, light)).toBe(true)
  expect(watch.moved(scene, light)).toBe(false)
})

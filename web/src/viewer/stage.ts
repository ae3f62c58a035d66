/** The stage: renderer, camera, lights. It draws when it is told to, and knows nothing of runs. */
import {
  BasicShadowMap,
  DirectionalLight,
  Group,
  HemisphereLight,
  PCFShadowMap,
  PerspectiveCamera,
  Scene,
  Vector3,
  WebGLRenderer,
} from 'three'
import { OrbitControls } from 'three/addons/controls/OrbitControls.js'
import { Backdrop } from './backdrop'
import { type Fit, fitted } from './camera'
import { ShadowWatch } from './casting'
import { askWhoDraws } from './drawing'
import type { Palette } from './theme'

const MOST_PIXELS_PER_POINT = 2
const SMOOTHED = 1.5 // pixels per point that smooth edges as they are shrunk, where nothing else does
const ANGLE = 30 // of view, degrees

export class Stage {
  readonly renderer: WebGLRenderer
  readonly scene = new Scene()
  readonly camera = new PerspectiveCamera(ANGLE, 1, 0.01, 60)
  readonly orbit: OrbitControls
  /** Of the shown frame, in m; scaled so that what is shown is about 1 large. */
  readonly space = new Group()
  /** Of the support frame. */
  readonly root = new Group()
  /** Whether somebody has moved the camera since it was placed. */
  moved = false
  /** No graphics card draws, but the processor: less is asked of it. */
  readonly byProcessor: boolean
  width = 1
  height = 1
  private sharpness = 1
  private readonly sky = new HemisphereLight()
  private readonly key = new DirectionalLight()
  private readonly fill = new DirectionalLight()
  private readonly backdrop = new Backdrop()
  private readonly shadows = new ShadowWatch()

  constructor(canvas: HTMLCanvasElement, changed: () => void) {
    this.byProcessor = askWhoDraws()
    // Multisampling doubles what each pixel costs the processor, of a coarse picture too.
    const antialias = !this.byProcessor
    this.renderer = new WebGLRenderer({ canvas, antialias, alpha: false, powerPreference: 'high-performance' })
    this.renderer.shadowMap.enabled = true
    this.renderer.shadowMap.autoUpdate = false
    canvas.addEventListener('webglcontextlost', () => this.shadows.forget())
    this.renderer.shadowMap.type = this.byProcessor ? BasicShadowMap : PCFShadowMap
    this.camera.up.set(0, 0, 1) // before the controls, which take it once
    this.camera.position.set(1, -3, 2)
    this.orbit = new OrbitControls(this.camera, canvas)
    this.orbit.enableDamping = false
    this.orbit.minDistance = 0.05
    this.orbit.maxDistance = 30
    this.orbit.addEventListener('change', changed)
    this.orbit.addEventListener('start', () => {
      this.moved = true
    })
    this.space.add(this.root)
    this.scene.add(this.backdrop.mesh, this.space, this.sky, this.key, this.key.target, this.fill, this.fill.target)
    this.setUpShadow()
  }

  private setUpShadow(): void {
    this.sky.position.set(0, 0, 1)
    this.key.castShadow = true
    this.key.shadow.mapSize.setScalar(this.byProcessor ? 512 : 2048)
    this.key.shadow.radius = 4
    this.key.shadow.normalBias = 0.004
    this.key.shadow.bias = -0.0004
    const { camera } = this.key.shadow
    Object.assign(camera, { left: -1.15, right: 1.15, top: 1.15, bottom: -1.15, near: 0.5, far: 8 })
    camera.updateProjectionMatrix()
  }

  look(palette: Palette): void {
    const { light } = palette
    this.sky.color.set(light.sky)
    this.sky.groundColor.set(light.ground)
    this.sky.intensity = light.ambient
    this.key.intensity = light.key
    this.key.shadow.intensity = light.shadow
    this.fill.intensity = light.fill
    this.backdrop.look(palette.glow, palette.background)
  }

  resize(width: number, height: number): void {
    this.width = Math.max(1, width)
    this.height = Math.max(1, height)
    this.usePixels()
    this.renderer.setSize(this.width, this.height, false)
    this.camera.aspect = this.width / this.height
    this.camera.updateProjectionMatrix()
  }

  /** Draw with a share of the pixels to a side. */
  sharpen(share: number): void {
    if (share === this.sharpness) return
    this.sharpness = share
    this.usePixels()
  }

  get sharp(): number {
    return this.sharpness
  }

  private usePixels(): void {
    const screen = pixelsPerPoint()
    const full = this.byProcessor && this.sharpness === 1 ? Math.max(screen, SMOOTHED) : screen
    this.renderer.setPixelRatio(this.sharpness * full)
  }

  /** Look at points (m, shown frame) from a direction, near enough to fill the stage. */
  frame(points: readonly Vector3[], direction: Vector3, up?: Vector3): void {
    const scaled = points.map((point) => point.clone().multiplyScalar(this.space.scale.x))
    const fit: Fit = fitted(scaled, direction, ANGLE, this.camera.aspect, up)
    this.orbit.target.copy(fit.target)
    this.camera.position.copy(fit.eye)
    this.orbit.update()
    this.moved = false
  }

  /** Put the light over a place of the shown frame (scaled). */
  shineOn(place: Vector3): void {
    this.key.target.position.copy(place)
    this.key.position.set(-1.1, -1.3, 3.2).add(place)
    this.fill.target.position.copy(place)
    this.fill.position.set(2.5, 1.2, 1.0).add(place)
  }

  /** Move camera and target together, by scaled lengths. */
  carry(by: Vector3): void {
    this.orbit.target.add(by)
    this.camera.position.add(by)
    this.orbit.update()
  }

  /** Where a place of the support frame is on the stage, CSS pixels. */
  project(place: Vector3): { x: number; y: number } | null {
    const at = this.root.localToWorld(projected.copy(place)).project(this.camera)
    if (!(at.z < 1)) return null
    return { x: (at.x * 0.5 + 0.5) * this.width, y: (0.5 - at.y * 0.5) * this.height }
  }

  /** Whether a place of the shown frame, m, is in the picture. */
  sees(place: Vector3): boolean {
    const at = projected.copy(place).multiplyScalar(this.space.scale.x).project(this.camera)
    return Math.abs(at.x) <= 1 && Math.abs(at.y) <= 1 && at.z < 1
  }

  /** How large, m, a CSS pixel is at a place of the support frame. */
  metresPerPixel(place: Vector3): number {
    const depth = this.root.localToWorld(projected.copy(place)).distanceTo(this.camera.position)
    return (2 * depth * Math.tan((ANGLE * Math.PI) / 360)) / this.height / this.space.scale.x
  }

  render(): void {
    const depth = this.camera.position.distanceTo(this.orbit.target)
    const near = Math.max(depth / 200, 0.002)
    if (Math.abs(near / this.camera.near - 1) > 0.2) {
      this.camera.near = near
      this.camera.updateProjectionMatrix()
    }
    this.renderer.shadowMap.needsUpdate = this.shadows.moved(this.scene, this.key)
    this.renderer.render(this.scene, this.camera)
  }

  dispose(): void {
    this.orbit.dispose()
    this.backdrop.dispose()
    this.renderer.dispose()
    this.renderer.forceContextLoss()
  }
}

/** As many pixels of the screen as are used for a CSS pixel where a picture is drawn in full, or more. */
export function pixelsPerPoint(): number {
  return Math.min(globalThis.devicePixelRatio || 1, MOST_PIXELS_PER_POINT)
}

const projected = new Vector3()

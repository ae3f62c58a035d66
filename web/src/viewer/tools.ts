/** What the pointer does on the stage besides turning it: drag the ball, draw a velocity, nudge, draw a guess. */
import { Vector3 } from 'three'
import { Arrow } from './arrow'
import type { Tool, ViewerEvents } from './contract'
import type { Emitter } from './emitter'
import { contactNormal } from './normals'
import { drawnVelocity, type Hit, pickNear, pickPlane, pickSupport, Stroke, sideAt } from './picking'
import type { Triple } from './scene'
import type { Stage } from './stage'
import { Swing } from './swing'
import type { Palette } from './theme'
import type { World } from './world'

const REACH = 26 // CSS pixels: how near to a ball one must point to take hold of it
const LEAST = 6 // CSS pixels: a shorter arrow is a click

interface Gesture {
  /** `at`: when, ms. */
  move(x: number, y: number, at: number): void
  end(at: number): void
}

export class Tools {
  tool: Tool = 'orbit'
  grabs = false
  private gesture: Gesture | null = null
  private readonly arrow = new Arrow(40)
  private readonly abort = new AbortController()

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly stage: Stage,
    private readonly world: World,
    private readonly events: Emitter<ViewerEvents>,
    private readonly host: { time: () => number; redraw: () => void },
  ) {
    stage.root.add(this.arrow.group)
    const options = { capture: true, signal: this.abort.signal }
    // On the parent and before the camera's controls, which would turn the stage.
    const parent = canvas.parentElement ?? canvas
    parent.addEventListener('pointerdown', (event) => this.down(event), options)
    parent.addEventListener('pointermove', (event) => this.move(event), options)
    for (const name of ['pointerup', 'pointercancel'] as const)
      parent.addEventListener(name, (event) => this.up(event), options)
  }

  look(palette: Palette): void {
    this.arrow.look(palette.arrows.velocity)
  }

  private down(event: PointerEvent): void {
    if (event.target !== this.canvas || event.button !== 0 || !this.acts) return
    this.gesture = this.begin(...this.at(event), event.timeStamp)
    if (!this.gesture) return
    event.stopPropagation()
    this.canvas.setPointerCapture(event.pointerId)
    this.host.redraw()
  }

  /** Is there something to be done with the pointer but turn the view? What rides along is where it was at the start. */
  private get acts(): boolean {
    return this.tool !== 'orbit' || (this.grabs && this.world.frame !== 'corotating')
  }

  /** Does a gesture that begins here do something with the body, or draw? */
  holds(x: number, y: number): boolean {
    return this.acts && (this.tool === 'draw' || this.nearBall(x, y))
  }

  private begin(x: number, y: number, at: number): Gesture | null {
    if (this.tool === 'draw') return this.draw(x, y)
    if (!this.nearBall(x, y)) return null
    if (this.tool === 'velocity' || this.tool === 'nudge') return this.throw(this.tool === 'nudge')
    return this.drag(x, y, at)
  }

  private move(event: PointerEvent): void {
    const [x, y] = this.at(event)
    if (!this.gesture) {
      this.canvas.dataset.near = String(this.holds(x, y))
      return
    }
    event.stopPropagation()
    this.gesture.move(x, y, event.timeStamp)
    this.host.redraw()
  }

  private up(event: PointerEvent): void {
    if (!this.gesture) return
    event.stopPropagation()
    if (this.canvas.hasPointerCapture(event.pointerId)) this.canvas.releasePointerCapture(event.pointerId)
    this.gesture.end(event.timeStamp)
    this.gesture = null
    this.host.redraw()
  }

  private at(event: PointerEvent): [number, number] {
    const box = this.canvas.getBoundingClientRect()
    return [event.clientX - box.left, event.clientY - box.top]
  }

  private nearBall(x: number, y: number): boolean {
    const body = this.world.actors[0]?.body
    const at = body && this.stage.project(body.group.position)
    if (!body || !at) return false
    const large = body.radius / this.stage.metresPerPixel(body.group.position)
    return Math.hypot(at.x - x, at.y - y) <= Math.max(REACH, 1.2 * large)
  }

  private drag(x: number, y: number, begun: number): Gesture {
    const { body } = this.world.actors[0]!
    const contact = body.track.contact(new Vector3())
    const place = body.group.position.clone()
    const lift = place.clone().sub(contact)
    const find = this.finder(x, y, contact)
    const swing = new Swing(LEAST * this.stage.metresPerPixel(place))
    swing.add(begun, place)
    const here = () => ({ x: place.x, y: place.y, z: place.z, contact: contact.toArray() })
    let taken = false
    return {
      move: (px, py, at) => {
        if (!taken && Math.hypot(px - x, py - y) < LEAST) return // a click moves nothing
        if (!taken) this.events.emit('dragstart', here())
        taken = true
        const hit = find(px, py)
        if (!hit) return
        contact.copy(hit.place)
        place.copy(contact).add(this.flat ? lift : hit.normal.multiplyScalar(lift.length()))
        this.world.hold(place)
        swing.add(at, place)
        this.events.emit('drag', here())
      },
      end: (at) => {
        if (!taken) return
        const velocity = this.tool === 'orbit' ? swing.velocity(at) : null
        this.events.emit('dragend', { ...here(), velocity })
      },
    }
  }

  private get flat(): boolean {
    return this.world.scenes[0]?.header.support.flat ?? false
  }

  /** Where the pointer moves a contact to. It is held where it was taken: the ball is not to leap under the pointer. */
  private finder(x: number, y: number, contact: Vector3): (px: number, py: number) => Hit | null {
    const { stage } = this
    const at = stage.project(contact) ?? { x, y }
    const side = sideAt(stage, this.world.support?.sides ?? [], at.x, at.y, contact)
    const { z: height } = contact
    return (px, py) => {
      const [ax, ay] = [px + at.x - x, py + at.y - y]
      const hit = side && pickNear(stage, side, ax, ay, contact)
      if (hit || !(this.flat || !this.world.support?.surface)) return hit
      const place = pickSupport(stage, null, ax, ay, height)
      return place && { place, normal: new Vector3(0, 0, 1) }
    }
  }

  private throw(nudge: boolean): Gesture {
    const { body, arrows } = this.world.actors[0]!
    const from = body.group.position.clone()
    const normal = contactNormal(
      body,
      this.world.scenes[0] ?? body.scene,
      body.track.contact(new Vector3()),
      new Vector3(),
    )
    const least = LEAST * this.stage.metresPerPixel(from)
    let velocity = new Vector3()
    const tell = (done: boolean) => {
      const drawn = { vx: velocity.x, vy: velocity.y, vz: velocity.z, done }
      if (nudge) this.events.emit('nudge', { ...drawn, time: this.host.time() })
      else this.events.emit('arrow', drawn)
    }
    return {
      move: (px, py) => {
        const hit = pickPlane(this.stage, px, py, from, normal)
        if (!hit) return
        velocity = drawnVelocity(from, hit, arrows.velocityScale, least)
        this.arrow.set(from, hit.sub(from), 0.009 * this.world.unit)
        tell(false)
      },
      end: () => {
        this.arrow.hide()
        tell(true)
      },
    }
  }

  private draw(x: number, y: number): Gesture | null {
    const surface = this.world.support?.surface ?? null
    const stroke = new Stroke(0.01 * this.world.unit)
    const { frame } = this.world
    const add = (px: number, py: number) => {
      const hit = pickSupport(this.stage, surface, px, py)
      if (hit) stroke.add(frame === 'corotating' ? this.world.toShown(hit) : hit)
    }
    const points = () => stroke.points.map(({ x: a, y: b, z: c }): Triple => [a, b, c])
    add(x, y)
    return {
      move: (px, py) => {
        add(px, py)
        this.world.sketch.set(points(), '', frame)
      },
      end: () => this.events.emit('sketch', { points: points(), frame }),
    }
  }

  dispose(): void {
    this.abort.abort()
    this.arrow.dispose()
  }
}

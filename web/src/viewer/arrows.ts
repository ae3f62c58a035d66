/** Arrows for velocity, forces and Ω on each body, to a stated scale; the friction cone; the guiding centre. */
import { Group, Quaternion, Vector3 } from 'three'
import { Arrow } from './arrow'
import type { BodyModel } from './bodies'
import { FrictionCone } from './cone'
import type { Show } from './contract'
import type { LabelLayer } from './labels'
import { type ArrowScale, arrowScale, steadyNumber, typicalSize } from './quantities'
import { materialVelocity, supportTwist, type Twist, typicalRidingSpeed } from './riding'
import type { Scene } from './scene'
import type { Palette } from './theme'

export type ArrowKind = 'velocity' | 'contactForce' | 'angularVelocity' | 'gravity'

export const ARROWS: Record<ArrowKind, { symbol: string; name: string; unit: string }> = {
  velocity: { symbol: 'V', name: 'velocity of the centre', unit: 'm/s' },
  contactForce: { symbol: 'R', name: 'contact force', unit: 'N' },
  angularVelocity: { symbol: 'Ω', name: 'angular velocity', unit: 'rad/s' },
  gravity: { symbol: 'mg', name: 'weight', unit: 'N' },
}

export const ARROW_KINDS = Object.keys(ARROWS) as ArrowKind[]

export interface LegendRow {
  kind: ArrowKind
  colour: string
  symbol: string
  name: string
  value: string
  scale: string
}

export type Scales = Record<ArrowKind, ArrowScale & { size: number }>

/** Scales that all bodies of a comparison share; `length` is how long, m, a large arrow should be; `riding`: who sees them. */
export function scalesOf(scenes: readonly Scene[], length: number, riding: boolean): Scales {
  const largest = (of: (scene: Scene) => number) => Math.max(0, ...scenes.map(of))
  const force = Math.max(
    largest((s) => typicalSize(s.columns.contact_force)),
    largest(weight),
  )
  const made = (size: number, unit: string) => ({ ...arrowScale(size, unit, length), size })
  const forces = made(force, 'N')
  return {
    velocity: made(largest(riding ? typicalRidingSpeed : (s) => typicalSize(s.columns.velocity)), 'm/s'),
    angularVelocity: made(
      largest((s) => typicalSize(s.columns.angular_velocity)),
      'rad/s',
    ),
    contactForce: forces,
    gravity: forces, // the same, so that one can see which of the two is larger
  }
}

/** The scales of before where they still do: an arrow is not to change its length when only its run has changed a little. */
export function steadyScales(before: Scales | null, now: Scales): Scales {
  if (!before) return now
  const kept = { ...now }
  for (const kind of ARROW_KINDS) {
    const ratio = before[kind].length / now[kind].length
    if (ratio > 1 / 3 && ratio < 3) kept[kind] = before[kind]
  }
  return kept
}

function weight({ header }: Scene): number {
  return header.body.mass * Math.hypot(...header.gravity)
}

export class BodyArrows {
  readonly group = new Group()
  readonly cone = new FrictionCone()
  private readonly arrows: Record<ArrowKind, Arrow>
  private readonly vector = new Vector3()
  private readonly contact = new Vector3()
  private readonly weight = new Vector3()
  private readonly material = new Vector3()
  private scales!: Scales
  /** How the support moves, where the observer rides on it. */
  private twist: Twist | null = null
  private unit = 1

  constructor(readonly body: BodyModel) {
    const made = ARROW_KINDS.map((kind, i) => [kind, new Arrow(20 + i)] as const)
    this.arrows = Object.fromEntries(made) as Record<ArrowKind, Arrow>
    for (const arrow of Object.values(this.arrows)) this.group.add(arrow.group)
    this.group.add(this.cone.group)
  }

  load(scales: Scales, unit: number): void {
    this.scales = scales
    this.unit = unit
    const { header } = this.body.scene
    // The header has gravity in the world frame; all else is drawn in the support frame.
    const [w, x, y, z] = header.to_world
    this.weight.set(...header.gravity).multiplyScalar(header.body.mass)
    this.weight.applyQuaternion(new Quaternion(x, y, z, w).conjugate())
  }

  /** m of arrow for 1 m/s. */
  get velocityScale(): number {
    return this.scales.velocity.length
  }

  look(palette: Palette): void {
    for (const kind of ARROW_KINDS) this.arrows[kind].look(palette.arrows[kind])
    this.cone.look(palette)
  }

  /** Velocities are those that the observer sees: one who rides on the support, or one who stands still. */
  ride(time: number | null): void {
    this.twist = time === null ? null : supportTwist(this.body.track, time)
  }

  update(show: Show, labels: LabelLayer, palette: Palette, thick: number, up: Vector3): void {
    const { track } = this.body
    track.contact(this.contact)
    const centre = this.body.group.position
    const longest = 1.2 * this.unit
    for (const kind of ARROW_KINDS) {
      const arrow = this.arrows[kind]
      const vector = show[kind] ? this.read(kind) : null
      if (!vector) {
        arrow.hide()
        continue
      }
      vector.multiplyScalar(this.scales[kind].length)
      if (vector.length() > longest) vector.setLength(longest)
      arrow.set(kind === 'contactForce' ? this.contact : centre, vector, thick)
      if (arrow.group.visible) labels.put(ARROWS[kind].symbol, arrow.tip, palette.arrows[kind], 'arrow')
    }
    const friction = this.body.scene.header.support.friction
    const touches = track.phase !== 2 && friction !== null && show.frictionCone
    const force = touches ? track.vector('contact_force', this.vector) : null
    this.cone.update(force, this.contact, up, friction ?? 0, 0.28 * this.unit)
  }

  legend(show: Show, palette: Palette): LegendRow[] {
    return ARROW_KINDS.filter((kind) => show[kind]).flatMap((kind) => {
      const vector = this.read(kind)
      const { size, words } = this.scales[kind]
      const value = vector ? `${steadyNumber(vector.length(), size)} ${ARROWS[kind].unit}` : '–'
      return [
        {
          kind,
          colour: palette.arrows[kind],
          symbol: ARROWS[kind].symbol,
          name: ARROWS[kind].name,
          value,
          scale: words,
        },
      ]
    })
  }

  private read(kind: ArrowKind): Vector3 | null {
    const { track } = this.body
    if (kind === 'gravity') return this.vector.copy(this.weight)
    const column = { velocity: 'velocity', contactForce: 'contact_force', angularVelocity: 'angular_velocity' } as const
    const vector = track.vector(column[kind], this.vector)
    if (!vector || !this.twist || kind === 'contactForce') return vector
    if (kind === 'angularVelocity') return vector.sub(this.twist.turning)
    return vector.sub(materialVelocity(this.twist, this.body.group.position, this.material))
  }

  dispose(): void {
    this.group.removeFromParent()
    for (const arrow of Object.values(this.arrows)) arrow.dispose()
    this.cone.dispose()
  }
}

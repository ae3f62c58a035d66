/**
 * Lines of a width in pixels, with round ends, that can grow with time and fade behind it: ten thousand points in one call.
 *
 * Not by instances of a piece: where the processor draws, as in a virtual machine, each instance costs as much as a call.
 */
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  InterleavedBuffer,
  InterleavedBufferAttribute,
  Mesh,
  ShaderMaterial,
  Vector2,
} from 'three'
import { countBefore } from './ascending'

/** In place of a point's time: no line comes here or goes on from here. */
export const BREAK = 1e30

const VERTEX = /* glsl */ `
attribute vec4 from;
attribute vec4 to;
uniform vec2 resolution;
uniform float width;
uniform float pixel;
uniform float now;
uniform float fading;
varying float vTime;
varying vec2 vPlace;
varying float vLength;
varying float vWidth;

void main() {
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  if (from.w > 1e29 || to.w > 1e29 || from.w > now) return;
  float share = to.w > now ? (now - from.w) / max(to.w - from.w, 1e-12) : 1.0;
  vec4 mp = modelViewMatrix * vec4(from.xyz, 1.0);
  vec4 mq = modelViewMatrix * vec4(mix(from.xyz, to.xyz, share), 1.0);
  // Towards the eye, off the surface that it lies on; what is new lies over what is old.
  float lift = 0.9975 - (fading > 0.0 ? 0.001 * exp((from.w - now) / fading) : 0.0);
  mp.xyz *= lift;
  mq.xyz *= lift;
  vec4 p = projectionMatrix * mp;
  vec4 q = projectionMatrix * mq;
  const float NEAR = 0.001;
  if (p.w < NEAR && q.w < NEAR) return;
  if (p.w < NEAR) p = mix(q, p, (q.w - NEAR) / (q.w - p.w));
  if (q.w < NEAR) q = mix(p, q, (p.w - NEAR) / (p.w - q.w));
  vec2 way = (q.xy / q.w - p.xy / p.w) * resolution * 0.5;
  float pixels = length(way);
  way = pixels > 1e-4 ? way / pixels : vec2(1.0, 0.0);
  // Beyond its ends by as much as closes the gap at a bend: little where points are dense and bends slight.
  vWidth = max(width, pixel); // thinner than a drawn pixel it would be seen here and there only
  float across = 0.5 * vWidth;
  float beyond = min(across, pixels);
  int at = gl_VertexID & 3;
  float side = (at & 1) == 0 ? -1.0 : 1.0;
  bool end = at > 1;
  vec4 corner = end ? q : p;
  vec2 offset = vec2(-way.y, way.x) * side * across + way * (end ? beyond : -beyond);
  corner.xy += offset / resolution * 2.0 * corner.w;
  gl_Position = corner;
  vLength = pixels;
  vPlace = vec2(side * across, end ? pixels + beyond : -beyond);
  vTime = mix(from.w, to.w, end ? share : 0.0);
}
`

const FRAGMENT = /* glsl */ `
uniform vec3 colour;
uniform vec3 faded;
uniform float now;
uniform float fading;
uniform float least;
uniform float dash;
varying float vTime;
varying vec2 vPlace;
varying float vLength;
varying float vWidth;

void main() {
  float beyond = max(max(-vPlace.y, vPlace.y - vLength), 0.0);
  if (beyond > 0.0 && vLength > 0.5 * vWidth && length(vec2(vPlace.x, beyond)) > 0.5 * vWidth) discard;
  if (dash > 0.0 && fract(vTime / dash) > 0.55) discard;
  float fresh = fading > 0.0 ? mix(least, 1.0, exp(-(now - vTime) / fading)) : 1.0;
  gl_FragColor = vec4(mix(faded, colour, fresh), 1.0); // as the eye sees it: the colours are not linear ones
}
`

export interface LineLook {
  colour: string
  faded?: string
  width: number
}

export class Line {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>
  private readonly uniforms = {
    resolution: { value: new Vector2(1, 1) },
    width: { value: 2 },
    pixel: { value: 1 },
    now: { value: 1e29 },
    fading: { value: 0 },
    least: { value: 1 },
    dash: { value: 0 },
    colour: { value: new Color() },
    faded: { value: new Color() },
  }

  private times = new Float32Array()
  private since = -Infinity

  constructor(order = 1) {
    const material = new ShaderMaterial({
      uniforms: this.uniforms,
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      // Not blended: overlapping pieces of a half-transparent line would show as beads. Multisampling makes it smooth.
      side: DoubleSide,
      toneMapped: false,
    })
    this.mesh = new Mesh(new BufferGeometry(), material)
    this.mesh.frustumCulled = false
    this.mesh.onBeforeRender = (renderer) => {
      this.uniforms.pixel.value = 1 / renderer.getPixelRatio()
      const [first, end] = this.shown
      this.mesh.geometry.setDrawRange(6 * first, 6 * Math.max(end - first, 0)) // just now: others may share it
    }
    this.mesh.renderOrder = order
    this.mesh.visible = false
  }

  /** Points as x, y, z, t; a point whose t is `BREAK` parts the line. */
  setPoints(points: Float32Array): void {
    const count = points.length / 4
    this.times = ascending(points)
    const geometry = new BufferGeometry()
    const buffer = new InterleavedBuffer(fourfold(points), 4)
    geometry.setAttribute('from', new InterleavedBufferAttribute(buffer, 4, 0))
    geometry.setAttribute('to', new InterleavedBufferAttribute(buffer, 4, 16)) // the next point of the same buffer
    geometry.setIndex(new BufferAttribute(quads(Math.max(count - 1, 0)), 1))
    this.mesh.geometry.dispose()
    this.mesh.geometry = geometry
    this.mesh.visible = count > 1
  }

  /** Take the points of another line, which go to the graphics card only once. */
  sharePoints(other: Line): void {
    this.mesh.geometry.dispose()
    this.mesh.geometry = other.mesh.geometry
    this.times = other.times
    this.mesh.visible = other.mesh.visible
  }

  look({ colour, faded, width }: LineLook): void {
    this.uniforms.colour.value.set(colour).convertLinearToSRGB()
    this.uniforms.faded.value.set(faded ?? colour).convertLinearToSRGB()
    this.uniforms.width.value = width
  }

  /** In CSS pixels, as widths are. */
  resize(width: number, height: number): void {
    this.uniforms.resolution.value.set(width, height)
  }

  /** Show it up to a time; older parts fade to the share `least` over so many seconds; none are older than `since`. */
  reach(now: number, fading = 0, least = 1, since = -Infinity): void {
    this.since = since
    this.uniforms.now.value = now
    this.uniforms.fading.value = fading
    this.uniforms.least.value = least
  }

  /** The first of the pieces that are drawn, and the one after the last: the rest would be tried in vain. */
  get shown(): [number, number] {
    const pieces = Math.max(this.times.length - 1, 0)
    const { value: now } = this.uniforms.now
    return [Math.max(countBefore(this.times, this.since) - 1, 0), Math.min(countBefore(this.times, now), pieces)]
  }

  /** Length of a dash and its gap, in the unit of t; 0 for a whole line. */
  set dash(length: number) {
    this.uniforms.dash.value = length
  }

  dispose(): void {
    this.mesh.removeFromParent()
    this.mesh.geometry.dispose()
    this.mesh.material.dispose()
  }
}

/** Each point four times, once for each corner of the piece that begins there: the shader knows them by their number. */
function fourfold(points: Float32Array): Float32Array {
  const out = new Float32Array(4 * points.length)
  for (let i = 0; i < points.length; i += 4) {
    const [x, y, z, t] = [points[i]!, points[i + 1]!, points[i + 2]!, points[i + 3]!]
    for (let at = 4 * i; at < 4 * i + 16; at += 4) {
      out[at] = x
      out[at + 1] = y
      out[at + 2] = z
      out[at + 3] = t
    }
  }
  return out
}

/** The times of points, a break taking the one before it; none where they do not grow, and all is drawn. */
function ascending(points: Float32Array): Float32Array<ArrayBuffer> {
  const times = new Float32Array(points.length / 4)
  for (let i = 0; i < times.length; i++) {
    const time = points[4 * i + 3]!
    times[i] = time < BREAK || i === 0 ? time : times[i - 1]!
    if (i > 0 && times[i]! < times[i - 1]!) return new Float32Array(times.length).fill(-1e30)
  }
  return times
}

const CORNERS = [0, 1, 2, 1, 3, 2]

/** The corners of so many pieces, two triangles each. */
function quads(count: number): Uint32Array {
  const out = new Uint32Array(6 * count)
  for (let i = 0; i < count; i++) {
    for (let k = 0; k < 6; k++) out[6 * i + k] = 4 * i + CORNERS[k]!
  }
  return out
}

/** Points of pieces of a line, joined with breaks between; t is the length along each piece. */
export function pieces(lines: readonly (readonly number[])[]): Float32Array {
  const out: number[] = []
  for (const line of lines) {
    if (out.length) out.push(0, 0, 0, BREAK)
    let along = 0
    for (let i = 0; i + 2 < line.length; i += 3) {
      if (i > 0) along += Math.hypot(line[i]! - line[i - 3]!, line[i + 1]! - line[i - 2]!, line[i + 2]! - line[i - 1]!)
      out.push(line[i]!, line[i + 1]!, line[i + 2]!, along)
    }
  }
  return new Float32Array(out)
}

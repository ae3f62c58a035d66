/** What stands behind everything: a soft glow on quiet ground, drawn only where nothing stands before it. */
import { BufferAttribute, BufferGeometry, Color, Mesh, ShaderMaterial } from 'three'

const VERTEX = /* glsl */ `
varying vec2 place;
void main() {
  place = position.xy;
  gl_Position = vec4(position.xy, 1.0, 1.0); // as far away as there is
}
`

const FRAGMENT = /* glsl */ `
uniform vec3 glow, ground;
varying vec2 place;
void main() {
  float off = length((place - vec2(0.0, 0.3)) * vec2(0.8, 0.95));
  // Half a step of noise hides the steps of so gentle a slope.
  float noise = fract(dot(fract(gl_FragCoord.xy * vec2(0.75487767, 0.56984029)), vec2(37.31, 23.17))) - 0.5;
  gl_FragColor = vec4(mix(glow, ground, smoothstep(0.0, 1.15, off)) + noise / 255.0, 1.0);
}
`

export class Backdrop {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>
  private readonly uniforms = { glow: { value: new Color() }, ground: { value: new Color() } }

  constructor() {
    // One triangle that covers the whole picture.
    const geometry = new BufferGeometry()
    geometry.setAttribute('position', new BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3))
    const material = new ShaderMaterial({
      uniforms: this.uniforms,
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      depthWrite: false,
      toneMapped: false,
    })
    this.mesh = new Mesh(geometry, material)
    this.mesh.frustumCulled = false
    this.mesh.renderOrder = 3 // after all that is solid, which then saves its pixels; glass comes later
  }

  look(glow: string, ground: string): void {
    this.uniforms.glow.value.set(glow).convertLinearToSRGB() // mixed as the screen shows it, which needs no powers
    this.uniforms.ground.value.set(ground).convertLinearToSRGB()
  }

  dispose(): void {
    this.mesh.geometry.dispose()
    this.mesh.material.dispose()
  }
}

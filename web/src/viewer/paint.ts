/** What is painted on bodies and supports, worked out for each pixel, so that its edges are crisp at any size. */
import { Color, type Material, type Vector4 } from 'three'

type Uniforms = Record<string, { value: unknown }>

const COMMON = /* glsl */ `
float crisp(float signed_) { // 0 to 1 across the zero of a function, one pixel wide
  return clamp(signed_ / max(fwidth(signed_), 1e-9) + 0.5, 0.0, 1.0);
}
float band(float value, float half_) { return crisp(half_ - abs(value)); }
`

/** Gores in two colours round the third body axis, an equator, and the two poles. */
const BODY = /* glsl */ `
vec3 painted(vec3 place, vec3 pattern) {
  if (plain > 0.5) return tint;
  float rho = length(place.xy) / girth;
  // The sine of three times the angle, from its own sine and cosine, which do not leap where the angle does.
  vec2 way = place.xy / max(length(place.xy), 1e-9);
  float gore = way.y * (3.0 * way.x * way.x - way.y * way.y);
  vec3 tone = mix(pale, tint, crisp(gore));
  float lines = round_ * band(pattern.z, 0.045);
  tone = mix(tone, ink, lines);
  float cap = crisp(0.24 - rho);
  vec3 north = mix(ink, pole, crisp(0.13 - rho));
  vec3 south = mix(ink, pale, crisp(0.17 - rho));
  return mix(tone, pattern.z > 0.0 ? north : south, cap);
}
`

const SUPPORT = /* glsl */ `
// Without branches, and only what such markings need: a processor that draws goes through both sides of each.
vec3 painted(vec2 marks, vec3 place) {
#ifdef SQUARE
  vec2 at = place.xy / spacing;
#elif defined(FLAT)
  vec2 at = vec2(marks.x * sectors, length(place.xy) / spacing);
#else
  vec2 at = vec2(marks.x * sectors, marks.y * rings);
#endif
  vec2 width = max(fwidth(at), 1e-9);
  vec2 whole = floor(at + 0.5);
  vec2 aside = (at - whole) / width; // pixels beyond the nearest of the lines
  // Lines are gone where they, so many of them to a pixel, would run together.
  vec2 ruled = clamp(0.5 * stroke + 0.5 - abs(aside), 0.0, 1.0) * (1.0 - smoothstep(0.15, 0.4, width));
  float fine = max(ruled.x, ruled.y);
  // 1 from an even whole number to the next and 0 from an odd one; their mean where they are too fine to see.
  vec2 odd = whole - 2.0 * floor(0.5 * whole);
  vec2 checks = mix(abs(clamp(aside + 0.5, 0.0, 1.0) - odd), vec2(0.5), smoothstep(0.25, 0.7, width));
#ifdef SQUARE
  float check = abs(checks.x - checks.y);
  vec2 beyond = (at - 5.0 * floor(0.2 * at + 0.5)) / width;
  vec2 fifths = clamp(0.8 * stroke + 0.5 - abs(beyond), 0.0, 1.0) * (1.0 - smoothstep(0.75, 2.0, width));
  float lines = max(0.4 * fine, 0.75 * max(fifths.x, fifths.y));
#else
  float check = checks.x;
  float lines = 0.55 * fine;
#endif
  vec3 tone = mix(base, other, check * contrast);
#ifndef SQUARE
  float first = clamp((0.5 - abs(at.x - 0.5)) / width.x + 0.5, 0.0, 1.0);
  tone = mix(tone, accent, first * accented);
#endif
  tone = mix(tone, line, lines);
  float near = 0.0;
  for (int i = 0; i < 5; i++) {
    if (i >= touching) break;
    vec3 off = (place - touches[i].xyz) / touches[i].w;
    near = max(near, exp(-3.0 * dot(off, off)));
  }
  return tone * (1.0 - shade * near);
}
float kept(vec3 place) { // of a plane whose edge is not shown: it is lost in the distance
#ifndef FLAT
  return 1.0;
#else
  vec2 off = abs(place.xy - fade.xy) / fade.zw;
#ifdef SQUARE
  float edge = max(off.x, off.y);
#else
  float edge = length(off);
#endif
  return 1.0 - smoothstep(0.72, 1.0, edge);
#endif
}
`

export interface BodyPaint {
  tint: { value: Color }
  pale: { value: Color }
  ink: { value: Color }
  pole: { value: Color }
  /** Largest distance from the third axis, m. */
  girth: { value: number }
  /** 1 for what is round all over, and has an equator. */
  round_: { value: number }
  /** 1 for what does not roll, as a charge. */
  plain: { value: number }
}

export function newBodyPaint(): BodyPaint {
  return {
    tint: { value: new Color() },
    pale: { value: new Color() },
    ink: { value: new Color() },
    pole: { value: new Color() },
    girth: { value: 1 },
    round_: { value: 1 },
    plain: { value: 0 },
  }
}

export interface SupportPaint {
  base: { value: Color }
  other: { value: Color }
  line: { value: Color }
  accent: { value: Color }
  sectors: { value: number }
  rings: { value: number }
  contrast: { value: number }
  accented: { value: number }
  spacing: { value: number }
  stroke: { value: number }
  shade: { value: number }
  /** How many of these are in use. */
  touching: { value: number }
  touches: { value: Vector4[] }
  fade: { value: Vector4 }
}

/** How a support is marked: `square`, else round its axis; `flat`: with rings at round distances, and it may fade. */
export interface Marking {
  square: boolean
  flat: boolean
}

/** Let a support's material hold just the code of its marking. */
export function mark(material: Material, { square, flat }: Marking): void {
  const wanted = { ...(square && { SQUARE: '' }), ...(flat && { FLAT: '' }) }
  if (String(Object.keys(wanted)) === String(Object.keys(material.defines ?? {}))) return
  material.defines = wanted
  material.needsUpdate = true
}

export function paintBody(material: Material, paint: BodyPaint): void {
  patch(material, paint as unknown as Uniforms, {
    key: 'trundle-body',
    varyings: 'varying vec3 vPattern;\nvarying vec3 vPlace;',
    attributes: 'attribute vec3 pattern;',
    vertex: 'vPattern = pattern;\nvPlace = position;',
    uniforms: 'uniform vec3 tint, pale, ink, pole;\nuniform float girth, round_, plain;',
    code: BODY,
    colour: 'diffuseColor.rgb = painted(vPlace, vPattern);',
  })
}

export function paintSupport(material: Material, paint: SupportPaint): void {
  patch(material, paint as unknown as Uniforms, {
    key: 'trundle-support',
    varyings: 'varying vec2 vMarks;\nvarying vec3 vPlace;',
    attributes: 'attribute vec2 marks;',
    vertex: 'vMarks = marks;\nvPlace = position;',
    uniforms: `uniform vec3 base, other, line, accent;
uniform float sectors, rings, contrast, accented, spacing, stroke, shade;
uniform int touching;
uniform vec4 touches[5];
uniform vec4 fade;`,
    code: SUPPORT,
    colour: 'diffuseColor.rgb = painted(vMarks, vPlace);\ndiffuseColor.a *= kept(vPlace);',
  })
}

interface Patch {
  key: string
  varyings: string
  attributes: string
  vertex: string
  uniforms: string
  code: string
  colour: string
}

function patch(material: Material, uniforms: Uniforms, parts: Patch): void {
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms)
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', `#include <common>\n${parts.attributes}\n${parts.varyings}`)
      .replace('#include <begin_vertex>', `#include <begin_vertex>\n${parts.vertex}`)
    shader.fragmentShader = shader.fragmentShader
      .replace('#include <common>', `#include <common>\n${parts.varyings}\n${parts.uniforms}\n${COMMON}\n${parts.code}`)
      .replace('#include <color_fragment>', `#include <color_fragment>\n${parts.colour}`)
  }
  material.customProgramCacheKey = () => parts.key
}

/** Colours and widths of the stage: Okabe and Ito's, on quiet ground. */
import type { Theme } from './contract'

export interface Palette {
  background: string
  glow: string
  support: { base: string; other: string; line: string; mark: string; edge: string; glass: number }
  body: { light: string; ink: string; pole: string }
  /** Of the bodies, by order; trails have the same. */
  bodies: readonly string[]
  arrows: {
    velocity: string
    contactForce: string
    angularVelocity: string
    gravity: string
    electric: string
    magnetic: string
    guide: string
    cone: string
    broken: string
    sketch: string
  }
  axes: readonly [string, string, string]
  light: { sky: string; ground: string; ambient: number; key: number; fill: number; shadow: number }
}

const LIGHT: Palette = {
  background: '#e6e8ea',
  glow: '#fbfbfa',
  support: { base: '#faf8f2', other: '#e9e6dd', line: '#b4b1a8', mark: '#f5d48c', edge: '#8b8f94', glass: 0.34 },
  body: { light: '#fdfcf8', ink: '#1a1c1f', pole: '#f0e442' },
  bodies: ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#b37c00'],
  arrows: {
    velocity: '#009e73',
    contactForce: '#d55e00',
    angularVelocity: '#a8478b',
    gravity: '#5b616a',
    electric: '#b37c00',
    magnetic: '#0072b2',
    guide: '#a8478b',
    cone: '#56b4e9',
    broken: '#d55e00',
    sketch: '#a8478b',
  },
  axes: ['#b03a00', '#00724f', '#00659f'],
  light: { sky: '#ffffff', ground: '#e2dfd7', ambient: 1.5, key: 1.5, fill: 0.35, shadow: 0.5 },
}

const DARK: Palette = {
  background: '#0f1214',
  glow: '#262c32',
  support: { base: '#4a5159', other: '#3f454c', line: '#7f8891', mark: '#8f7a4d', edge: '#959ba3', glass: 0.3 },
  body: { light: '#f4f1ea', ink: '#0d0f11', pole: '#f0e442' },
  bodies: ['#56b4e9', '#e8762b', '#1fb58b', '#d892b8', '#e69f00'],
  arrows: {
    velocity: '#1fd3a0',
    contactForce: '#ff8a4c',
    angularVelocity: '#e7a4cb',
    gravity: '#c9ced4',
    electric: '#e69f00',
    magnetic: '#56b4e9',
    guide: '#e7a4cb',
    cone: '#56b4e9',
    broken: '#ff8a4c',
    sketch: '#f0e442',
  },
  axes: ['#ff9257', '#3fc79a', '#6cc0ee'],
  light: { sky: '#ffffff', ground: '#30353b', ambient: 1.45, key: 2.2, fill: 0.5, shadow: 0.75 },
}

export function paletteOf(theme: 'light' | 'dark'): Palette {
  return theme === 'dark' ? DARK : LIGHT
}

/** What "auto" means now, and a call when that changes. */
export function watchTheme(theme: Theme, changed: (theme: 'light' | 'dark') => void): () => void {
  if (theme !== 'auto' || typeof matchMedia !== 'function') {
    changed(theme === 'dark' ? 'dark' : 'light')
    return () => undefined
  }
  const query = matchMedia('(prefers-color-scheme: dark)')
  const tell = () => changed(query.matches ? 'dark' : 'light')
  query.addEventListener('change', tell)
  tell()
  return () => query.removeEventListener('change', tell)
}

export interface Widths {
  trail: number
  rim: number
  guide: number
  sketch: number
}

/** CSS pixels; they grow with the page's type, as on a very large screen. */
export function widthsOf(projector: boolean, page: Element): Widths {
  const grown = Number.parseFloat(getComputedStyle(page).fontSize) / 16 || 1
  const [trail, rim, guide, sketch] = projector ? [5, 2.4, 3, 5] : [3.6, 1.6, 2, 3.6]
  return { trail: trail * grown, rim: rim * grown, guide: guide * grown, sketch: sketch * grown }
}

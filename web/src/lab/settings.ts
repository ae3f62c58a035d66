/** What the visitor likes, kept in the browser where that is allowed: theme, projector, units. */

export type Theme = 'system' | 'light' | 'dark'

export interface Settings {
  theme: Theme
  /** Large type, thick lines, panels folded away: for a lecture hall. */
  projector: boolean
  /** The visitor asks for less motion (read from the system, not kept). */
  readonly reducedMotion: boolean
  /** The unit last chosen for a kind of quantity: {"angular velocity": "rpm", "length": "cm"}. */
  units: Readonly<Record<string, string>>
}

export interface SettingsStore {
  readonly value: Settings
  /** Light or dark, as it is drawn now; on paper light. */
  readonly appearance: 'light' | 'dark'
  change(part: Partial<Pick<Settings, 'theme' | 'projector' | 'units'>>): void
  subscribe(listener: (settings: Settings) => void): () => void
}

const KEY = 'trundle.lab'

function kept(): Partial<Settings> {
  try {
    const found: unknown = JSON.parse(localStorage.getItem(KEY) ?? '{}')
    return typeof found === 'object' && found !== null ? (found as Partial<Settings>) : {}
  } catch {
    return {}
  }
}

function keep(settings: Settings): void {
  try {
    const { theme, projector, units } = settings
    localStorage.setItem(KEY, JSON.stringify({ theme, projector, units }))
  } catch {
    // Storage may be forbidden; the lab works without it.
  }
}

export function createSettings(): SettingsStore {
  const dark = matchMedia('(prefers-color-scheme: dark)')
  const calm = matchMedia('(prefers-reduced-motion: reduce)')
  const before = kept()
  let value: Settings = {
    theme: before.theme === 'light' || before.theme === 'dark' ? before.theme : 'system',
    projector: before.projector === true,
    units: { ...before.units },
    get reducedMotion() {
      return calm.matches
    },
  }
  const listeners = new Set<(settings: Settings) => void>()
  let onPaper = false
  const chosen = () => (value.theme === 'system' ? (dark.matches ? 'dark' : 'light') : value.theme)
  const appearance = () => (onPaper ? 'light' : chosen())

  function apply(): void {
    document.documentElement.dataset.theme = appearance()
    document.documentElement.toggleAttribute('data-projector', value.projector)
    for (const listener of [...listeners]) listener(value)
  }
  dark.addEventListener('change', apply)
  calm.addEventListener('change', apply)
  for (const when of ['beforeprint', 'afterprint'] as const)
    addEventListener(when, () => {
      onPaper = when === 'beforeprint'
      apply()
    })
  apply()

  return {
    get value() {
      return value
    },
    get appearance() {
      return appearance()
    },
    change(part) {
      value = Object.defineProperty({ ...value, ...part }, 'reducedMotion', {
        get: () => calm.matches,
        enumerable: true,
      })
      keep(value)
      apply()
    },
    subscribe(listener) {
      listeners.add(listener)
      return () => listeners.delete(listener)
    },
  }
}

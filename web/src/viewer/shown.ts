/** What is shown besides body and support: switches that tell when they are turned. */
import type { Show } from './contract'

const SHOWN: Show = {
  velocity: false,
  contactForce: false,
  angularVelocity: false,
  gravity: false,
  frictionCone: false,
  guidingCentre: false,
  trail: true,
  ahead: false,
  axes: false,
}

/** The switches, some of them set, as an object that calls `changed` whenever one is set anew. */
export function liveShow(set: Partial<Show>, changed: () => void): Show {
  return new Proxy(
    { ...SHOWN, ...set },
    {
      set(target, name, value) {
        if (!(name in SHOWN)) throw new Error(`show has ${Object.keys(SHOWN).join(', ')}; got ${String(name)}`)
        const key = name as keyof Show
        if (target[key] === Boolean(value)) return true
        target[key] = Boolean(value)
        changed()
        return true
      },
    },
  )
}

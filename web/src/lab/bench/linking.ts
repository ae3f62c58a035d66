/** The address follows the scenario: by name while it is a shipped one, by its whole content once it is changed. */
import type { App } from '../app'
import type { Scenario } from '../scenario'
import { decode, encode } from '../share'

export interface Linking {
  /** Remember that this is what a shipped name holds. */
  shipped(name: string, scenario: Scenario): void
  changed(scenario: Scenario): void
  /** Take what the address says: a name or a code. False where it says nothing, or nothing that can be read. */
  read(byName: (name: string) => Promise<void>, byContent: (scenario: Scenario) => void): Promise<boolean>
  stop(): void
}

const CALM = 350

export function createLinking(app: App): Linking {
  let timer: ReturnType<typeof setTimeout> | undefined
  let origin: { name: string; text: string } | undefined
  let written = ''

  async function write(scenario: Scenario): Promise<void> {
    const same = origin?.text === JSON.stringify(scenario)
    const params: Record<string, string> = same && origin ? { name: origin.name } : { s: await encode(scenario) }
    if (app.route.page !== 'bench') return
    written = params.s ?? params.name ?? ''
    app.router.replace('bench', params)
  }

  return {
    shipped(name, scenario) {
      origin = { name, text: JSON.stringify(scenario) }
    },
    changed(scenario) {
      clearTimeout(timer)
      timer = setTimeout(() => void write(scenario), CALM)
    },
    async read(byName, byContent) {
      const { s, name } = app.route.params
      if ((s ?? name ?? '') === written && written !== '') return true
      if (name) {
        await byName(name)
        return true
      }
      if (!s) return false
      try {
        const scenario = await decode(s)
        written = s
        byContent(scenario)
        return true
      } catch (error) {
        app.toast(error instanceof Error ? error.message : 'The link cannot be read.', 'error')
        return false
      }
    },
    stop: () => clearTimeout(timer),
  }
}

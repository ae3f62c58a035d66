/** A map that is filled in, a second's work at a time, until it is finished, stopped, or another takes its place. */
import type { Api, MapPart, MapRequest } from '../../api'
import { isAbort } from '../../api'

export interface Computing {
  /** Begin with another map. */
  begin(request: MapRequest): void
  stop(): void
  goOn(): void
  readonly state: State
}

export type State = 'idle' | 'computing' | 'stopped' | 'finished' | 'failed'

export interface Listener {
  drawn(part: MapPart, request: MapRequest): void
  failed(error: unknown): void
  state(state: State): void
}

export function createComputing(api: Pick<Api, 'map'>, listener: Listener): Computing {
  let request: MapRequest | undefined
  let places: number[] = []
  let values: (number | null)[] = []
  let controller: AbortController | undefined
  let state: State = 'idle'

  function become(next: State): void {
    state = next
    listener.state(next)
  }

  async function go(): Promise<void> {
    const asked = request
    if (!asked) return
    const mine = new AbortController()
    controller = mine
    become('computing')
    try {
      for (;;) {
        const part = await api.map({ ...asked, places, values }, { lane: null, signal: mine.signal })
        if (mine.signal.aborted) return
        places = [...places, ...part.places]
        values = [...values, ...part.values]
        listener.drawn(part, asked)
        if (part.left === 0) break
      }
      become('finished')
    } catch (error) {
      if (mine.signal.aborted || isAbort(error)) return
      become('failed')
      listener.failed(error)
    }
  }

  function stop(): void {
    controller?.abort()
    if (state === 'computing') become('stopped')
  }

  return {
    begin(next) {
      stop()
      request = next
      places = []
      values = []
      void go()
    },
    stop,
    goOn() {
      if (state === 'stopped' || state === 'failed') void go()
    },
    get state() {
      return state
    },
  }
}

/** Holds the current scenario. A change is a new object; what was before can be had back. */
import type { Scenario } from './scenario'

export interface Change {
  /** What made it: 'control', 'drag', 'undo', 'open', 'url', a page's own word; 'first' cannot be undone. */
  source: string
  /** Another scenario was opened: what is shown of it begins from nothing. */
  opens?: boolean
  /** The motion begins anew, from where a body was. */
  restarts?: boolean
  /** Changes of one gesture (a slider being dragged) share a word, and undo as one. */
  gesture?: string | undefined
}

export interface Store {
  readonly scenario: Scenario
  /** Call the listener at every change; returns how to stop. */
  subscribe(listener: (scenario: Scenario, change: Change) => void): () => void
  set(scenario: Scenario, change?: Change): void
  undo(): boolean
  redo(): boolean
  readonly canUndo: boolean
  readonly canRedo: boolean
}

const DEPTH = 100

export function createStore(first: Scenario): Store {
  let current = first
  let past: Scenario[] = []
  let future: Scenario[] = []
  let gesture: string | undefined
  const listeners = new Set<(scenario: Scenario, change: Change) => void>()
  const tell = (change: Change) => {
    for (const listener of [...listeners]) listener(current, change)
  }

  function travel(from: Scenario[], to: Scenario[], source: string): boolean {
    const next = from.pop()
    if (!next) return false
    to.push(current)
    current = next
    gesture = undefined
    tell({ source })
    return true
  }

  return {
    get scenario() {
      return current
    },
    get canUndo() {
      return past.length > 0
    },
    get canRedo() {
      return future.length > 0
    },
    subscribe(listener) {
      listeners.add(listener)
      return () => listeners.delete(listener)
    },
    set(scenario, change = { source: 'control' }) {
      if (scenario === current) return
      const continues = change.gesture !== undefined && change.gesture === gesture
      if (change.source === 'first') past = []
      else if (!continues) past = [...past, current].slice(-DEPTH)
      future = []
      gesture = change.gesture
      current = scenario
      tell(change)
    },
    undo: () => travel(past, future, 'undo'),
    redo: () => travel(future, past, 'redo'),
  }
}

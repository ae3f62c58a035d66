/** A lane carries one request at a time: a newer one cancels the older. */

export interface Lanes {
  /** A signal for a new request in the lane; the one before it is aborted. No lane: never aborted but by `outer`. */
  enter(lane: string | null, outer?: AbortSignal): { signal: AbortSignal; leave(): void }
  /** Abort what is under way in a lane, or everywhere. */
  cancel(lane?: string): void
}

export function createLanes(): Lanes {
  const running = new Map<string, AbortController>()
  return {
    enter(lane, outer) {
      const controller = new AbortController()
      if (lane !== null) {
        running.get(lane)?.abort()
        running.set(lane, controller)
      }
      const stop = () => controller.abort()
      if (outer?.aborted) stop()
      outer?.addEventListener('abort', stop, { once: true })
      return {
        signal: controller.signal,
        leave() {
          outer?.removeEventListener('abort', stop)
          if (lane !== null && running.get(lane) === controller) running.delete(lane)
        },
      }
    },
    cancel(lane) {
      const chosen = lane === undefined ? [...running.keys()] : [lane]
      for (const name of chosen) {
        running.get(name)?.abort()
        running.delete(name)
      }
    },
  }
}

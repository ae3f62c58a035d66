/** Runs a job for the newest request: one at a time, an overdue elder is cancelled. */

export interface RunnerOptions<Request, Answer> {
  run(request: Request, signal: AbortSignal): Promise<Answer>
  done(answer: Answer, request: Request): void
  failed(error: unknown, request: Request): void
  /** Busy or idle: for a sign of work. */
  state?(busy: boolean): void
  /**
   * How old a running job may be when a newer request comes (ms): a younger one is let finish and shown, so
   * that a slider that is dragged without a stop still draws; an older one is aborted.
   */
  patience?: number
  /** When to begin with what is asked in the task under way, and asked again. */
  soon?(callback: () => void): void
  now?(): number
}

export interface Runner<Request> {
  ask(request: Request): void
  stop(): void
}

export function createRunner<Request, Answer>(options: RunnerOptions<Request, Answer>): Runner<Request> {
  const { patience = 500, soon = queueMicrotask, now = () => performance.now() } = options
  let waiting: { request: Request } | null = null
  let running: { controller: AbortController; began: number } | null = null
  let scheduled = false
  let timer: ReturnType<typeof setTimeout> | undefined

  function schedule(): void {
    if (scheduled) return
    scheduled = true
    soon(() => {
      scheduled = false
      start()
    })
  }

  function start(): void {
    if (!waiting) return
    if (running) {
      const left = patience - (now() - running.began)
      clearTimeout(timer)
      if (left > 0) {
        timer = setTimeout(start, left)
        return
      }
      running.controller.abort()
    }
    const { request } = waiting
    waiting = null
    void go(request)
  }

  async function go(request: Request): Promise<void> {
    const mine = { controller: new AbortController(), began: now() }
    running = mine
    options.state?.(true)
    try {
      const answer = await options.run(request, mine.controller.signal)
      if (!mine.controller.signal.aborted) options.done(answer, request)
    } catch (error) {
      // What went wrong with an old request is no news once a newer one waits.
      if (!mine.controller.signal.aborted && !waiting) options.failed(error, request)
    }
    if (running !== mine) return
    running = null
    options.state?.(false)
    if (waiting) schedule()
  }

  return {
    ask(request) {
      waiting = { request }
      schedule()
    },
    stop() {
      waiting = null
      clearTimeout(timer)
      if (!running) return
      running.controller.abort()
      running = null
      options.state?.(false)
    },
  }
}

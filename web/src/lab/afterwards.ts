/** What can wait until the next picture is on its way to the screen; of several such jobs only the newest is done. */

export interface Afterwards {
  run(job: () => void): void
  readonly waiting: boolean
  stop(): void
}

export function createAfterwards(
  frame: (callback: () => void) => void = (callback) => void requestAnimationFrame(callback),
): Afterwards {
  let job: (() => void) | undefined
  let framed = false
  return {
    run(next) {
      job = next
      if (framed) return
      framed = true
      // A frame's callbacks run before the page is laid out and painted; a task after them, behind that.
      frame(() =>
        setTimeout(() => {
          framed = false
          const due = job
          job = undefined
          due?.()
        }),
      )
    },
    get waiting() {
      return job !== undefined
    },
    stop() {
      job = undefined
    },
  }
}

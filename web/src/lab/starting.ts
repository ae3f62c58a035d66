/** While the lab's processes start, the first answer has to wait for them: the page says so. */
import type { Api } from './api'

const SOON = 400 // ms: who is answered before that has waited for nothing
const AGAIN = 400

const pause = (milliseconds: number) => new Promise<void>((done) => setTimeout(done, milliseconds))

export async function tellWhileStarting(
  api: Pick<Api, 'ready'>,
  hold: (text: string) => () => void,
  wait: (milliseconds: number) => Promise<void> = pause,
): Promise<void> {
  let release: (() => void) | undefined
  try {
    await wait(SOON)
    while (!(await api.ready()).ready) {
      release ??= hold('Starting the workers … The first answer waits for them.')
      await wait(AGAIN)
    }
  } catch {
    // A server that does not answer is told of by whatever else was asked of it.
  }
  release?.()
}

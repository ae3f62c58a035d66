/** Says the motion in words while it runs, at a pace that may be chosen, and wherever it is stopped. */
import type { Viewer } from './contract'
import { element, say } from './elements'
import { narrated, WORDS } from './narration'
import type { Scene } from './scene'

const KEY = 'trundle.words'
const CALM = 500 // ms that the film stands before it is said where

function kept(): number {
  try {
    const found = Number(localStorage.getItem(KEY) ?? Number.NaN)
    return WORDS.paces.some(([pace]) => pace === found) ? found : 5
  } catch {
    return 5
  }
}

/** s between two sayings, of every stage of the page; 0 for none. */
let pace: number | undefined

export class Narrator {
  /** What is said: read out by a screen reader, seen by nobody. */
  readonly element = element('p', 'tr-heard', { 'aria-live': 'polite', 'data-testid': 'narration' })
  /** The choice of the pace: seen while it has the focus. */
  readonly choice: HTMLElement
  private last = 0
  private timer: ReturnType<typeof setTimeout> | undefined
  private told = Number.NaN

  constructor(
    private readonly viewer: Pick<Viewer, 'time' | 'playing' | 'on'>,
    private readonly scenes: () => readonly Scene[],
  ) {
    pace ??= kept()
    const select = element('select', 'tr-words', { 'aria-label': WORDS.describe })
    for (const [value, words] of WORDS.paces) select.append(element('option', '', { value: String(value) }, words))
    select.value = String(pace)
    select.addEventListener('change', () => this.choose(Number(select.value)))
    this.choice = element('label', 'tr-heard tr-choice', {}, `${WORDS.describe}: `, select)
    viewer.on('time', () => this.ticked())
    viewer.on('pause', () => this.soon())
  }

  private choose(next: number): void {
    pace = next
    try {
      localStorage.setItem(KEY, String(next))
    } catch {
      // It holds for this page.
    }
    if (next) this.speak()
    else say(this.element, '')
  }

  private ticked(): void {
    if (!pace || this.viewer.time === this.told) return
    if (!this.viewer.playing) {
      this.soon()
      return
    }
    if (performance.now() - this.last >= 1000 * pace) this.speak()
  }

  private soon(): void {
    clearTimeout(this.timer)
    if (pace) this.timer = setTimeout(() => this.speak(), CALM)
  }

  private speak(): void {
    this.last = performance.now()
    this.told = this.viewer.time
    say(this.element, narrated(this.scenes(), this.viewer.time))
  }

  dispose(): void {
    clearTimeout(this.timer)
  }
}

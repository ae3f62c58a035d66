/** Small pictures of scenarios, asked for when they come into view, and a few at a time. */
import { h } from './dom'

const AT_ONCE = 2
let running = 0
const waiting: (() => void)[] = []

function begin(job: () => void): void {
  if (running >= AT_ONCE) {
    waiting.push(job)
    return
  }
  running += 1
  job()
}

function ended(): void {
  running -= 1
  const next = waiting.shift()
  if (next) begin(next)
}

const seen =
  typeof IntersectionObserver === 'function'
    ? new IntersectionObserver(
        (entries) => {
          for (const { isIntersecting, target } of entries) {
            if (!isIntersecting) continue
            seen?.unobserve(target)
            load(target as HTMLImageElement)
          }
        },
        { rootMargin: '200px' },
      )
    : null

function load(image: HTMLImageElement): void {
  begin(() => {
    if (!image.isConnected) {
      ended()
      return
    }
    image.addEventListener('load', ended, { once: true })
    image.addEventListener(
      'error',
      () => {
        image.hidden = true
        ended()
      },
      { once: true },
    )
    image.src = `api/scenarios/${encodeURIComponent(image.dataset.picture!)}/picture`
  })
}

/** The picture of a scenario that ships. It says nothing that its title does not. */
export function pictureOf(name: string): HTMLImageElement {
  const image = h('img', { class: 'scenario-picture', alt: '', width: 240, height: 150, 'data-picture': name })
  if (seen) seen.observe(image)
  else load(image)
  return image
}

/** A live page: sliders, the motion by the law that the page holds, its curves, and what happens in it in words. */
import type { Viewer } from '../viewer/contract'
import { element, say } from '../viewer/elements'
import { shortNumber } from '../viewer/quantities'
import type { Scene } from '../viewer/scene'
import { Bench } from './bench'
import type { Course } from './course'
import { Graph } from './graph'
import type { LiveHeader } from './header'
import { Pictures } from './picture'
import type { Answer, Question } from './worker'

/** Let a page compute its own motion; what is shown until then is the one that lies in it. */
export function startLive(root: Document, stage: HTMLElement, viewer: Viewer, scene: Scene, live: LiveHeader): void {
  const text = root.querySelector('script[data-trundle-law]')?.textContent
  if (text) new LivePage(root, stage, viewer, scene, live, text)
}

class LivePage {
  private readonly pictures: Pictures
  private readonly bench: Bench
  private readonly graph: Graph
  private readonly headline = element('p', 'live-headline', { role: 'status' })
  private readonly worker: Worker | null
  private readonly aside: HTMLElement | null
  private asked = 0
  private busy = false
  private waiting = false

  constructor(
    root: Document,
    stage: HTMLElement,
    private readonly viewer: Viewer,
    scene: Scene,
    private readonly live: LiveHeader,
    law: string,
  ) {
    this.pictures = new Pictures(scene, live)
    this.bench = new Bench(live.sliders, () => this.ask())
    this.graph = new Graph(live.curves, (time) => {
      viewer.pause()
      viewer.seek(time)
    })
    this.aside = root.querySelector('.page-figures')
    const side = element(
      'section',
      'live-side',
      { 'aria-label': 'Numbers to change' },
      this.headline,
      this.bench.element,
    )
    stage.after(side, this.graph.element)
    viewer.on('time', ({ time }) => this.graph.at(time))
    this.worker = started(law)
    if (!this.worker) {
      this.fail('This browser lets no page compute in the background. The motion is that of the file.')
      return
    }
    this.worker.addEventListener('message', ({ data }: MessageEvent<Answer>) => this.hear(data))
    this.worker.addEventListener('error', () => this.fail('The law could not be run in this browser.'))
    this.ask()
  }

  private ask(): void {
    this.waiting = this.busy
    if (this.busy || !this.worker) return
    this.busy = true
    const question: Question = { id: ++this.asked, values: [...this.bench.values] }
    this.worker.postMessage(question)
  }

  private hear({ id, course, failed, values }: Answer): void {
    this.busy = false
    if (course) this.show(course, values, id)
    else this.say(`These numbers lead nowhere: ${failed}`)
    if (this.waiting) this.ask()
  }

  private show(course: Course, values: readonly number[], id: number): void {
    this.viewer.setScenes([this.pictures.scene(course, values)], {
      keepTime: id > 1,
      keepCamera: id > 1,
      rests: !this.waiting,
    })
    this.graph.show(course)
    this.graph.at(this.viewer.time)
    this.say(told(course, this.live))
    this.aside?.toggleAttribute('data-of-the-file', this.bench.moved)
  }

  private say(text: string): void {
    say(this.headline, text)
  }

  private fail(text: string): void {
    this.say(text)
    this.bench.disabled = true
  }
}

/** A worker whose script is the law, and what follows it: text of this page, nothing else. */
function started(law: string): Worker | null {
  try {
    const address = URL.createObjectURL(new Blob([law], { type: 'text/javascript' }))
    return new Worker(address)
  } catch {
    return null
  }
}

/** What happens in a course, in a line. */
function told(course: Course, { film }: LiveHeader): string {
  const { time, rows, events, ended } = course
  const [x, speed] = [film.indexOf('position_x'), film.indexOf('speed')]
  let [path, fastest] = [0, 0]
  rows.forEach((row, i) => {
    fastest = Math.max(fastest, row[speed]!)
    const before = rows[i - 1]
    if (before) path += Math.hypot(row[x]! - before[x]!, row[x + 1]! - before[x + 1]!, row[x + 2]! - before[x + 2]!)
  })
  const first = events.filter((event) => event !== ended)
  const named = first.slice(0, 3).map(({ text }) => text)
  if (first.length > 3) named.push(`${first.length - 3} more events`)
  named.push(
    ended ? `${ended.text}: the law ends there` : `Goes on for all of ${shortNumber(time.at(-1)! - time[0]!)} s`,
  )
  return `${named.join('. ')}. Path ${lengthOf(path)}, fastest ${shortNumber(fastest)} m/s.`
}

function lengthOf(metres: number): string {
  return metres < 1 ? `${shortNumber(100 * metres)} cm` : `${shortNumber(metres)} m`
}

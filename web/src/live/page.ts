/** A live page: sliders, the motion by the law that the page holds, its curves, and what happens in it in words. */
import { type Curves, createCurves } from '../curves/curves'
import type { Viewer } from '../viewer/contract'
import { element, hide, put, say } from '../viewer/elements'
import { beside, capital } from '../viewer/headline'
import { shortNumber } from '../viewer/quantities'
import type { Headline, Scene } from '../viewer/scene'
import { Bench } from './bench'
import type { Course } from './course'
import type { LiveHeader } from './header'
import { Pictures } from './picture'
import type { Answer, Question } from './worker'

const OF_THE_FILE = 'A slider has been moved: what follows is of the numbers as they are in the file.'

/** Let a page compute its own motion; what is shown until then is the one that lies in it. */
export function startLive(
  root: Document,
  stage: HTMLElement,
  viewer: Viewer,
  scene: Scene,
  live: LiveHeader,
): { restyle(): void } | null {
  const text = root.querySelector('script[data-trundle-law]')?.textContent
  return text ? new LivePage(root, stage, viewer, scene, live, text) : null
}

class LivePage {
  private readonly pictures: Pictures
  private readonly bench: Bench
  private readonly curves: Curves
  private readonly shown = element('strong', 'live-shown')
  private readonly other = element('span', 'live-other')
  private readonly happens = element('p', 'live-happens')
  private readonly headline = element('div', 'live-headline', { role: 'status' }, this.shown, this.other, this.happens)
  private readonly worker: Worker | null
  private readonly ofTheFile = element('p', 'page-of-the-file', { hidden: '' }, OF_THE_FILE)
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
    this.curves = createCurves(
      (text) => this.say(text),
      (time) => {
        viewer.pause()
        viewer.seek(time)
      },
    )
    root.querySelector('.page-figures')?.prepend(this.ofTheFile)
    const side = element(
      'section',
      'live-side',
      { 'aria-label': 'Numbers to change' },
      this.headline,
      this.bench.element,
    )
    const graph = element('section', 'live-graph', { 'aria-label': 'Curves' }, this.curves.element)
    stage.after(side, graph)
    viewer.on('time', ({ time }) => this.curves.at(time))
    this.tell(scene.header.headline ?? null)
    this.curves.update(scene)
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

  private hear({ id, course, headline, failed, values }: Answer): void {
    this.busy = false
    if (course) this.show(course, headline, values, id)
    else {
      this.tell(null)
      this.say(`These numbers lead nowhere: ${failed}`)
    }
    if (this.waiting) this.ask()
  }

  private show(course: Course, headline: Headline | null, values: readonly number[], id: number): void {
    const scene = this.pictures.scene(course, values)
    this.viewer.setScenes([scene], {
      keepTime: id > 1,
      keepCamera: id > 1,
      rests: !this.waiting,
    })
    this.curves.update(scene)
    this.curves.at(this.viewer.time)
    this.tell(headline)
    this.say(told(course, this.live))
    hide(this.ofTheFile, !this.bench.moved)
  }

  private tell(headline: Headline | null): void {
    say(this.shown, headline ? capital(headline.text) : '')
    say(this.other, headline ? beside(headline) : '')
    put(this.shown, 'title', headline?.how ?? '')
  }

  private say(text: string): void {
    say(this.happens, text)
  }

  /** Light or dark: the curves are drawn anew. */
  restyle(): void {
    this.curves.restyle()
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
  const [x, v] = [film.indexOf('position_x'), film.indexOf('velocity_x')]
  let [path, fastest] = [0, 0]
  rows.forEach((row, i) => {
    fastest = Math.max(fastest, Math.hypot(row[v]!, row[v + 1]!, row[v + 2]!))
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

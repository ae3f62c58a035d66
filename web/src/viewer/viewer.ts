/** The viewer: one stage with its bar, for the lab page, the notebook and saved pages. */
import './viewer.css'
import { Vector3 } from 'three'
import type { Frame, SceneOptions, Show, Theme, Tool, Viewer, ViewerEvents, ViewerOptions } from './contract'
import { Controls, pressed } from './controls'
import { element, leaveThePageItsSwipes, leaveThePageItsWheel, pngOf, put, say } from './elements'
import { Emitter } from './emitter'
import { Fallback } from './fallback'
import { framesOf, nextFrame } from './frames'
import { LabelLayer } from './labels'
import { Legend } from './legend'
import { Narrator } from './narrator'
import { Player, watchable } from './player'
import { type Scene, saidOf, type Triple } from './scene'
import { Sharpness } from './sharpness'
import { liveShow } from './shown'
import { Sound } from './sound'
import { Stage } from './stage'
import { paletteOf, watchTheme, widthsOf } from './theme'
import { Tools } from './tools'
import { sampleBefore } from './track'
import { World } from './world'

export type { Frame, Show, Theme, Tool, Viewer, ViewerEvents, ViewerOptions } from './contract'

export function createViewer(host: HTMLElement, options: ViewerOptions = {}): Viewer {
  return new StageViewer(host, options)
}

class StageViewer implements Viewer {
  private readonly events = new Emitter<ViewerEvents>()
  private readonly player = new Player()
  private readonly heard = new Sound()
  private readonly labels: LabelLayer
  private readonly legend = new Legend()
  private readonly note = element('p', 'tr-note')
  private readonly frameElement: HTMLElement
  private readonly canvas: HTMLCanvasElement
  private readonly root: HTMLElement
  private readonly fallback: Fallback | null
  private readonly stage: Stage | null
  private readonly sharpness: Sharpness | null
  private readonly world: World | null
  private readonly tools: Tools | null
  private readonly controls: Controls | null
  private readonly narrator: Narrator
  private readonly watcher: ResizeObserver | null
  private readonly abort = new AbortController()
  private readonly live: Show
  private scenes: readonly Scene[] = []
  private pending = 0
  private drawnTheme: 'light' | 'dark' = 'light'
  private unwatch: () => void = () => undefined
  private large = false
  private shownFrame: Frame
  private followed = false
  private placed = false
  private fromTop = false
  private readonly place = new Vector3()

  constructor(
    private readonly host: HTMLElement,
    options: ViewerOptions,
  ) {
    this.shownFrame = options.frame ?? 'world'
    this.live = liveShow(options.show ?? {}, () => this.showChanged())
    this.canvas = element('canvas', 'tr-canvas', {
      'data-testid': 'stage',
      tabindex: '0',
      role: 'img',
      'aria-label': saidOf([]),
    })
    this.labels = new LabelLayer(document)
    this.frameElement = element('div', 'tr-stage', {}, this.canvas, this.labels.element, this.legend.element, this.note)
    this.root = element('div', 'tr-viewer', {}, this.frameElement)
    host.append(this.root)
    this.stage = this.openStage()
    this.sharpness = this.stage && new Sharpness(this.stage, () => this.draw())
    this.fallback = this.stage ? null : new Fallback(document)
    if (this.fallback) this.frameElement.replaceChildren(this.fallback.element)
    this.world = this.stage && new World(this.stage, options)
    const redraw = () => this.invalidate()
    this.tools =
      this.stage &&
      this.world &&
      new Tools(this.canvas, this.stage, this.world, this.events, { time: () => this.time, redraw })
    this.controls = options.controls === false ? null : new Controls(this)
    if (this.controls) this.root.append(this.controls.element)
    this.narrator = new Narrator(this, () => this.scenes)
    this.root.append(this.narrator.element)
    this.controls?.element.append(this.narrator.choice)
    this.large = options.projector ?? false
    this.theme = options.theme ?? 'auto'
    this.watcher = this.watchSize()
    this.resize()
    this.listen()
    this.controls?.refresh()
  }

  private openStage(): Stage | null {
    try {
      return new Stage(this.canvas, () => this.invalidate())
    } catch {
      return null // no WebGL here
    }
  }

  private watchSize(): ResizeObserver | null {
    if (typeof ResizeObserver === 'undefined') return null
    const watcher = new ResizeObserver(() => this.resize())
    watcher.observe(this.frameElement)
    return watcher
  }

  private listen(): void {
    const { signal } = this.abort
    this.root.addEventListener('keydown', (event) => this.key(event), { signal })
    leaveThePageItsWheel(this.frameElement, this.canvas, signal)
    leaveThePageItsSwipes(this.canvas, (x, y) => this.tools?.holds(x, y) ?? false, signal)
    this.canvas.addEventListener('webglcontextlost', (event) => event.preventDefault(), { signal })
    this.canvas.addEventListener('webglcontextrestored', () => this.invalidate(), { signal })
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return
    const target = event.target as HTMLElement
    // Buttons have keys of their own; sliders and lists have more.
    const own = target.matches('input, select, textarea') ? /^( |Enter|Arrow.*|Home|End)$/ : /^( |Enter)$/
    if (target !== this.canvas && own.test(event.key)) return
    const ends = { begin: this.player.begin, nextFrame: () => this.nextFrame() }
    if (pressed(this, event.key, event.shiftKey, ends)) event.preventDefault()
  }

  private nextFrame(): void {
    let next = nextFrame(this.frame)
    while (!framesOf(this.scenes).includes(next)) next = nextFrame(next)
    this.frame = next
  }

  setScenes(scenes: readonly Scene[], options: SceneOptions = {}): void {
    this.scenes = scenes
    this.heard.runs = scenes
    const begin = Math.min(...scenes.map(({ columns }) => columns.time[0] ?? 0))
    const end = Math.max(...scenes.map(({ columns }) => columns.time[columns.time.length - 1] ?? 0))
    this.player.load(scenes.length ? begin : 0, scenes.length ? end - begin : 0, options.keepTime ?? false)
    const keep = (options.keepCamera ?? false) && this.placed
    if (this.world) this.world.frame = this.frame
    this.world?.setScenes(scenes, keep)
    this.fallback?.setScenes(scenes, this.frame)
    this.controls?.setScenes(scenes, this.player.begin)
    say(this.note, this.world?.support?.note ?? '')
    put(this.canvas, 'aria-label', saidOf(scenes))
    if (!keep && scenes.length) this.resetCamera()
    else if (options.rests && this.lost) this.aim(this.fromTop)
    this.controls?.refresh()
    if (options.rests) this.sharpness?.rest()
    // At once: the picture is made while the page does what else there is to do for the new runs.
    if (this.playing) this.invalidate()
    else this.drawNow()
  }

  play(): void {
    if (this.playing) return
    this.player.play()
    if (!this.playing) return
    this.world?.hold(null)
    this.events.emit('play', { time: this.time })
    this.controls?.refresh()
    this.invalidate()
  }

  pause(): void {
    if (!this.playing) return
    this.player.pause()
    this.stopped()
  }

  private stopped(): void {
    this.heard.rest()
    this.events.emit('pause', { time: this.time })
    this.controls?.refresh()
    this.invalidate()
  }

  seek(time: number): void {
    this.heard.leap()
    this.player.seek(time)
    this.world?.hold(null)
    this.events.emit('time', { time: this.time })
    this.invalidate()
  }

  step(by: number): void {
    const times = this.scenes[0]?.columns.time
    if (!times) return
    this.pause()
    const at = sampleBefore(times, this.time + 1e-9)
    const between = this.time - times[at]! > 1e-9
    const next = at + by + (by < 0 && between ? 1 : 0)
    this.seek(times[Math.min(Math.max(next, 0), times.length - 1)]!)
  }

  get time(): number {
    return this.player.time
  }
  get duration(): number {
    return this.player.duration
  }
  get playing(): boolean {
    return this.player.playing
  }

  get speed(): number {
    return this.player.speed
  }
  set speed(speed: number) {
    this.player.speed = Math.min(Math.max(Number.isFinite(speed) ? speed : 1, 0.01), 100)
    this.controls?.refresh()
  }

  suit(): number {
    const turning = this.scenes.map(({ columns }) => fastest(columns.angular_velocity))
    this.speed = watchable(this.duration, Math.max(0, ...turning))
    this.loop = this.duration < BRIEF
    return this.speed
  }

  get loop(): boolean {
    return this.player.loop
  }
  set loop(loop: boolean) {
    this.player.loop = loop
    this.controls?.refresh()
  }

  get sound(): boolean {
    return this.heard.on
  }
  set sound(on: boolean) {
    this.heard.on = on
    this.controls?.refresh()
  }

  get flashes(): number {
    return this.world?.flashes ?? 0
  }
  set flashes(flashes: number) {
    if (this.world) this.world.flashes = Math.max(0, Number.isFinite(flashes) ? flashes : 0)
    this.controls?.refresh()
    this.invalidate()
  }

  get frame(): Frame {
    return this.shownFrame
  }
  set frame(frame: Frame) {
    if (frame === this.shownFrame) return
    this.shownFrame = frame
    if (this.world) this.world.frame = frame
    this.fallback?.setScenes(this.scenes, frame)
    if (this.scenes.length) this.resetCamera()
    this.events.emit('frame', { frame })
    this.controls?.refresh()
    this.invalidate()
  }

  get show(): Show {
    return this.live
  }
  set show(part: Partial<Show>) {
    Object.assign(this.live, part)
  }

  private showChanged(): void {
    this.events.emit('show', { show: { ...this.live } })
    this.controls?.refresh()
    this.invalidate()
  }

  get tool(): Tool {
    return this.tools?.tool ?? 'orbit'
  }
  set tool(tool: Tool) {
    if (this.tools) this.tools.tool = tool
    this.canvas.dataset.tool = tool
  }

  get grabs(): boolean {
    return this.tools?.grabs ?? false
  }
  set grabs(grabs: boolean) {
    if (this.tools) this.tools.grabs = grabs
  }

  get theme(): 'light' | 'dark' {
    return this.drawnTheme
  }

  set theme(theme: Theme) {
    this.unwatch()
    this.unwatch = watchTheme(theme, (drawn) => {
      this.drawnTheme = drawn
      this.look()
    })
  }

  get projector(): boolean {
    return this.large
  }
  set projector(large: boolean) {
    this.large = large
    this.look()
  }

  private look(): void {
    const palette = paletteOf(this.drawnTheme)
    this.root.dataset.theme = this.drawnTheme
    this.root.toggleAttribute('data-projector', this.large)
    this.stage?.look(palette)
    this.world?.look(palette, widthsOf(this.large, document.documentElement))
    this.tools?.look(palette)
    this.invalidate()
  }

  get follow(): boolean {
    return this.followed
  }
  set follow(follow: boolean) {
    this.followed = follow
    this.controls?.refresh()
  }

  resetCamera(): void {
    this.aim(false)
  }
  topView(): void {
    this.aim(true)
  }

  /** Whether the runs have left the picture, and nobody has chosen what it shows. */
  private get lost(): boolean {
    return !this.followed && this.stage?.moved === false && this.world?.strays === true
  }

  private aim(top: boolean): void {
    this.world?.update(this.time, this.live, this.labels, false)
    this.world?.resetCamera(top)
    this.fromTop = top
    this.placed = true
    this.invalidate()
  }

  setSketch(
    points: readonly Triple[] | readonly [number, number][] | null,
    label = '',
    frame: Frame = 'support',
  ): void {
    this.world?.sketch.set(points, label, frame)
    this.invalidate()
  }

  on<Name extends keyof ViewerEvents>(name: Name, listener: (event: ViewerEvents[Name]) => void): () => void {
    return this.events.on(name, listener)
  }

  async snapshot(): Promise<Blob> {
    const { stage } = this
    if (!stage) throw new Error('A snapshot needs WebGL, which this browser lacks.')
    stage.sharpen(1)
    this.draw() // the canvas keeps its picture only until the browser has shown it
    return pngOf(this.canvas)
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.frameElement
    if (!this.stage || !clientWidth || !clientHeight) return
    this.stage.resize(clientWidth, clientHeight)
    this.world?.look(paletteOf(this.drawnTheme), widthsOf(this.large, document.documentElement))
    this.world?.resize()
    if (this.scenes.length && !this.stage.moved) this.aim(this.fromTop)
    this.drawNow() // a resized canvas is blank until drawn
  }

  private invalidate(): void {
    if (this.pending || this.abort.signal.aborted) return
    this.pending = requestAnimationFrame((now) => {
      this.pending = 0
      this.tick(now)
    })
  }

  private drawNow(): void {
    if (this.abort.signal.aborted) return
    cancelAnimationFrame(this.pending)
    this.pending = 0
    this.tick(performance.now())
  }

  private tick(now: number): void {
    const ran = this.playing
    if (ran) this.sharpness?.frame(now)
    else this.sharpness?.changed()
    const ended = this.player.tick(now)
    if (ran) {
      this.heard.at(this.time)
      this.events.emit('time', { time: this.time })
    }
    this.draw()
    if (ended) this.stopped()
    if (this.playing) this.invalidate()
  }

  private draw(): void {
    this.world?.update(this.time, this.live, this.labels, this.followed)
    this.fallback?.update(this.time)
    this.stage?.render()
    this.legend.update(this.world?.legend(this.live) ?? [])
    this.controls?.update()
    this.tell()
  }

  /** What is drawn, in attributes of the host: for tests, and for whoever wants to style by it. */
  private tell(): void {
    const { x, y, z } = this.world?.shownPlace(0, this.place) ?? this.place
    const { time, playing, frame } = this
    const said = { time, playing, frame, x, y, z, bodies: this.scenes.length, sharp: this.stage?.sharp ?? 1 }
    for (const [name, value] of Object.entries(said)) {
      this.host.dataset[name] = typeof value === 'number' ? String(Number(value.toPrecision(9))) : String(value)
    }
  }

  dispose(): void {
    this.abort.abort()
    if (this.pending) cancelAnimationFrame(this.pending)
    this.sharpness?.dispose()
    this.heard.dispose()
    this.narrator.dispose()
    this.unwatch()
    this.watcher?.disconnect()
    this.tools?.dispose()
    this.world?.dispose()
    this.stage?.dispose()
    this.events.clear()
    this.root.remove()
  }
}

const BRIEF = 3 // s: a run that is over so soon is shown again and again

/** The fastest turning of a run, rad/s. */
function fastest(turning: Float32Array | undefined): number {
  let most = 0
  for (let i = 0; i + 2 < (turning?.length ?? 0); i += 3)
    most = Math.max(most, Math.hypot(turning![i]!, turning![i + 1]!, turning![i + 2]!))
  return most
}

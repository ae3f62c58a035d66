/** The keys of the bench, wherever the focus is but in a text. */
import type { App } from '../app'
import { listen } from '../dom'
import { isTyping } from '../shell'
import { copyLink } from './files'
import type { Stage } from './stage'

interface Actions {
  stage: Stage
  pick(): void
  fold(side: 'left' | 'right'): void
}

export function benchKeys(app: App, { stage, pick, fold }: Actions): () => void {
  const { viewer } = stage
  const actions: Record<string, () => void> = {
    '/': pick,
    '[': () => fold('left'),
    ']': () => fold('right'),
    l: () => void copyLink(app),
    o: () => stage.useTool('orbit'),
    d: () => stage.useTool('drag'),
    v: () => stage.useTool('velocity'),
    n: () => stage.useTool('nudge'),
    r: () => viewer.resetCamera(),
    t: () => viewer.topView(),
    ' ': () => (viewer.playing ? viewer.pause() : viewer.play()),
    ArrowRight: () => viewer.step(1),
    ArrowLeft: () => viewer.step(-1),
    Home: () => viewer.seek(0),
    End: () => viewer.seek(viewer.duration),
  }
  /** Keys that a control under the focus uses itself. */
  const own = (event: KeyboardEvent) => {
    const target = event.target as HTMLElement
    if (event.key === ' ') return target.closest('button, summary, input, a, [role=radio]') !== null
    return (
      /^(Arrow|Home|End)/.test(event.key) &&
      target.closest('input, [role=tablist], [role=radiogroup], [role=slider]') !== null
    )
  }
  return listen(document, 'keydown', (event: KeyboardEvent) => {
    if (event.defaultPrevented || document.querySelector('dialog[open]')) return
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === 'z' && !isTyping(event)) {
      if (event.shiftKey) app.store.redo()
      else app.store.undo()
      event.preventDefault()
      return
    }
    if (event.ctrlKey || event.metaKey || event.altKey || event.shiftKey || isTyping(event) || own(event)) return
    const action = actions[event.key]
    if (!action) return
    event.preventDefault()
    action()
  })
}

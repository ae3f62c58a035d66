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
  const actions: Record<string, () => void> = {
    '/': pick,
    ',': () => fold('left'),
    '.': () => fold('right'),
    r: () => stage.viewer.resetCamera(),
    s: () => void copyLink(app),
    o: () => stage.useTool('orbit'),
    d: () => stage.useTool('drag'),
    v: () => stage.useTool('velocity'),
    n: () => stage.useTool('nudge'),
  }
  return listen(document, 'keydown', (event: KeyboardEvent) => {
    if (event.defaultPrevented || document.querySelector('dialog[open]')) return
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === 'z' && !isTyping(event)) {
      if (event.shiftKey) app.store.redo()
      else app.store.undo()
      event.preventDefault()
      return
    }
    if (event.ctrlKey || event.metaKey || event.altKey || isTyping(event) || isOwn(event)) return
    const action = event.shiftKey ? undefined : actions[event.key]
    if (action) action()
    else if (!toViewer(event, stage)) return
    event.preventDefault()
  })
}

/** Does a control under the focus use this key itself? */
function isOwn(event: KeyboardEvent): boolean {
  const target = event.target as HTMLElement
  if (event.key === ' ') return target.closest('button, summary, input, a, [role=radio]') !== null
  if (!/^(Arrow|Home|End|Page)/.test(event.key)) return false
  return target.closest('input, [role=tablist], [role=radiogroup], [role=slider], [role=tabpanel]') !== null
}

/** The viewer knows keys of its own while it has the focus; here it gets them wherever the focus is. */
function toViewer(event: KeyboardEvent, stage: Stage): boolean {
  const canvas = stage.element.querySelector<HTMLElement>('[data-testid="stage"]')
  if (!canvas || stage.element.contains(event.target as Node)) return false
  const { key, code, shiftKey } = event
  if (key === 'Enter' && event.target !== document.body) return false // which has a button pressed
  const again = new KeyboardEvent('keydown', { key, code, shiftKey, bubbles: true, cancelable: true })
  return !canvas.dispatchEvent(again)
}

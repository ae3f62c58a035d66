/** A picture of the stage for the printer: its own canvas keeps none. */
import { element } from './elements'
import type { Viewer } from './viewer'

/** Put a picture of the stage, as it stands, after its host while the page is printed. Returns what ends this. */
export function printed(host: HTMLElement, viewer: Viewer): () => void {
  const picture = element('canvas', 'tr-printed', { role: 'img', 'aria-label': 'The motion, as it stands' })
  function begin(): void {
    const canvas = host.querySelector<HTMLCanvasElement>('[data-testid="stage"]')
    const drawn = viewer.snapshot() // drawn at once; its file is not waited for
    drawn.catch(() => undefined)
    if (!canvas?.width || !canvas.height) return
    Object.assign(picture, { width: canvas.width, height: canvas.height })
    picture.getContext('2d')?.drawImage(canvas, 0, 0)
    host.after(picture)
  }
  const end = () => picture.remove()
  addEventListener('beforeprint', begin)
  addEventListener('afterprint', end)
  return () => {
    end()
    removeEventListener('beforeprint', begin)
    removeEventListener('afterprint', end)
  }
}

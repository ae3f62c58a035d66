/** The sheet at the bottom of a phone: pulled up and down by its handle, or stepped by the arrow keys. */
import { put } from '../../viewer/elements'
import { h } from '../dom'

const STOPS = [12, 42, 80]

export function createSheet(content: HTMLElement): { handle: HTMLElement; open(): void } {
  let height = STOPS[1]!
  const handle = h('button', {
    class: 'sheet-handle',
    type: 'button',
    role: 'slider',
    'aria-orientation': 'vertical',
    'aria-label': 'Height of the sheet',
    'aria-valuemin': STOPS[0],
    'aria-valuemax': STOPS[2],
  })

  function set(next: number): void {
    height = Math.min(STOPS[2]!, Math.max(STOPS[0]!, next))
    content.style.setProperty('--sheet', `${height}dvh`)
    handle.setAttribute('aria-valuenow', String(Math.round(height)))
    put(handle, 'aria-valuetext', `${Math.round(height)} % of the screen`)
  }

  const nearest = () => STOPS.reduce((best, stop) => (Math.abs(stop - height) < Math.abs(best - height) ? stop : best))

  handle.addEventListener('pointerdown', (down) => {
    const from = height
    let moved = false
    handle.setPointerCapture(down.pointerId)
    const move = (event: PointerEvent) => {
      moved ||= Math.abs(event.clientY - down.clientY) > 4
      set(from + ((down.clientY - event.clientY) / window.innerHeight) * 100)
    }
    const up = () => {
      handle.removeEventListener('pointermove', move)
      if (moved) set(nearest())
      else set(from > STOPS[0]! ? STOPS[0]! : STOPS[1]!)
    }
    handle.addEventListener('pointermove', move)
    handle.addEventListener('pointerup', up, { once: true })
    handle.addEventListener('pointercancel', up, { once: true })
  })
  handle.addEventListener('keydown', (event) => {
    const at = STOPS.indexOf(nearest())
    const to = { ArrowUp: at + 1, ArrowDown: at - 1, Home: 0, End: STOPS.length - 1 }[event.key]
    if (to === undefined) return
    event.preventDefault()
    event.stopPropagation()
    set(STOPS[Math.min(STOPS.length - 1, Math.max(0, to))]!)
  })
  set(height)
  return {
    handle,
    open() {
      if (height < STOPS[1]!) set(STOPS[1]!)
    },
  }
}

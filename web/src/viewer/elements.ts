/** Small helpers for elements of the page, and the icons of the bar. Words are said in the reader's language. */
import { t, WORDED } from '../languages/translate'

const SVG = 'http://www.w3.org/2000/svg'

export function element<Name extends keyof HTMLElementTagNameMap>(
  name: Name,
  className: string,
  attributes: Record<string, string> = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[Name] {
  const made = document.createElement(name)
  if (className) made.className = className
  for (const [key, value] of Object.entries(attributes)) put(made, key, value)
  made.append(...children.map((child) => (typeof child === 'string' ? t(child) : child)))
  return made
}

/** Say something there. What is said already is left alone, here and below: the browser would lay it out once more. */
export function say(element: Element, text: string): void {
  const said = t(text)
  if (element.textContent !== said) element.textContent = said
}

/** Hide it, or show it. */
export function hide(element: HTMLElement, hidden: boolean): void {
  if (element.hidden !== hidden) element.hidden = hidden
}

/** Before a part is hidden or disabled: a focus within goes to the first of others that takes it, and is not lost. */
export function handOver(from: Element, ...others: HTMLElement[]): void {
  for (const other of others) if (from.contains(document.activeElement)) other.focus()
}

/** Set an attribute. */
export function put(element: Element, name: string, value: string): void {
  const said = WORDED.has(name) ? t(value) : value
  if (element.getAttribute(name) !== said) element.setAttribute(name, said)
}

/** Drawn on a field of 20 by 20, in strokes. */
const ICONS = {
  play: 'M6.5 4.2v11.6L16 10z',
  pause: 'M6.5 4.5v11M13.5 4.5v11',
  back: 'M13.5 5 8 10l5.5 5M5.5 5v10',
  forward: 'M6.5 5 12 10l-5.5 5M14.5 5v10',
  loop: 'M4 9a5 5 0 0 1 5-4.5h5.5M12 2l2.8 2.5L12 7M16 11a5 5 0 0 1-5 4.5H5.5M8 18l-2.8-2.5L8 13',
  home: 'M3.5 10 10 4l6.5 6M5.5 8.6V16h9V8.6',
  top: 'M10 3v7M7 7.5l3 3 3-3M3 15c0-1.7 3.1-3 7-3s7 1.3 7 3-3.1 3-7 3-7-1.3-7-3z',
  follow: 'M10 6.2a3.8 3.8 0 1 0 0 7.6 3.8 3.8 0 0 0 0-7.6zM10 2v4M10 14v4M2 10h4M14 10h4',
  sound: 'M3 8v4h3l4 3.5v-11L6 8zM13 7.5a3.6 3.6 0 0 1 0 5M15.3 5a7 7 0 0 1 0 10',
} as const

export type Icon = keyof typeof ICONS

export function icon(name: Icon): SVGSVGElement {
  const svg = document.createElementNS(SVG, 'svg')
  svg.setAttribute('viewBox', '0 0 20 20')
  svg.setAttribute('class', `tr-icon tr-icon-${name}`)
  svg.setAttribute('aria-hidden', 'true')
  const path = document.createElementNS(SVG, 'path')
  path.setAttribute('d', ICONS[name])
  svg.append(path)
  return svg
}

export function iconButton(name: Icon, label: string, pressed: () => void): HTMLButtonElement {
  const button = element('button', 'tr-button', { type: 'button', 'aria-label': label, title: label }, icon(name))
  button.addEventListener('click', pressed)
  return button
}

/** On a page that scrolls, the wheel scrolls it until somebody has taken hold of the stage. */
export function leaveThePageItsWheel(frame: HTMLElement, stage: HTMLElement, signal: AbortSignal): void {
  const heard = (event: WheelEvent) => {
    if (scrolls() && document.activeElement !== stage && !event.ctrlKey) event.stopPropagation()
  }
  frame.addEventListener('wheel', heard, { signal, capture: true })
}

/** Is the page longer than its window? */
function scrolls(): boolean {
  const page = document.scrollingElement
  return page !== null && page.scrollHeight > page.clientHeight + 1
}

/** On a page that scrolls, a finger scrolls it up and down, unless it takes hold of something. */
export function leaveThePageItsSwipes(
  stage: HTMLElement,
  holds: (x: number, y: number) => boolean,
  signal: AbortSignal,
): void {
  const heard = (event: TouchEvent) => {
    const [finger] = event.touches
    const box = stage.getBoundingClientRect()
    if (!finger || event.touches.length > 1) return
    stage.style.touchAction = scrolls() ? 'pan-y' : 'none' // over what the camera's controls set
    if (holds(finger.clientX - box.left, finger.clientY - box.top)) event.preventDefault()
  }
  stage.style.touchAction = 'pan-y'
  stage.addEventListener('touchstart', heard, { signal, passive: false })
}

/** What a canvas shows, as a PNG file. */
export function pngOf(canvas: HTMLCanvasElement): Promise<Blob> {
  return new Promise((done, failed) => {
    canvas.toBlob((blob) => (blob ? done(blob) : failed(new Error('The browser made no picture.'))), 'image/png')
  })
}

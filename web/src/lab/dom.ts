/** Small helpers to make elements. No framework: what is on the page is what was made here, in the reader's language. */
import { t, WORDED } from '../languages/translate'

type Attribute = string | number | boolean | null | undefined
type Handlers = { [E in keyof HTMLElementEventMap as `on${E}`]?: (event: HTMLElementEventMap[E]) => void }
export type Properties = Handlers & { [name: string]: Attribute | ((event: never) => void) }
export type Child = Node | string | number | null | undefined | false

/** Make an element: h('button', { class: 'quiet', onclick: go }, 'Go'). Attributes false or null are left out. */
export function h<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag,
  properties: Properties = {},
  ...children: (Child | Child[])[]
): HTMLElementTagNameMap[Tag] {
  const element = document.createElement(tag)
  assign(element, properties)
  element.append(...(tag === 'code' || tag === 'pre' ? nodes(children, (text) => text) : nodes(children)))
  return element
}

/** The same for SVG. */
export function svg<Tag extends keyof SVGElementTagNameMap>(
  tag: Tag,
  properties: Properties = {},
  ...children: (Child | Child[])[]
): SVGElementTagNameMap[Tag] {
  const element = document.createElementNS('http://www.w3.org/2000/svg', tag)
  assign(element, properties)
  element.append(...nodes(children))
  return element
}

function assign(element: Element, properties: Properties): void {
  for (const [name, value] of Object.entries(properties)) {
    if (typeof value === 'function') element.addEventListener(name.slice(2), value as (event: Event) => void)
    else if (value === true) element.setAttribute(name, '')
    else if (value !== false && value !== null && value !== undefined)
      element.setAttribute(name, WORDED.has(name) ? t(String(value)) : String(value))
  }
}

function nodes(children: (Child | Child[])[], said: (text: string) => string = t): (Node | string)[] {
  return children
    .flat()
    .filter((child) => child !== null && child !== undefined && child !== false)
    .map((child) => (child instanceof Node ? child : said(String(child))))
}

/** A message of the package without the marks of code, which nobody at the page writes. */
export function plainly(message: string): string {
  return message.replaceAll('`', '')
}

/** Put these in place of whatever is inside. */
export function fill(host: Element, ...children: (Child | Child[])[]): void {
  host.replaceChildren(...nodes(children))
}

/** Listen until the returned function is called. */
export function listen<E extends keyof WindowEventMap>(
  target: EventTarget,
  name: E | string,
  listener: (event: WindowEventMap[E]) => void,
  options?: AddEventListenerOptions,
): () => void {
  target.addEventListener(name, listener as EventListener, options)
  return () => target.removeEventListener(name, listener as EventListener, options)
}

let made = 0
/** An id nobody else on the page has, for labels and descriptions. */
export function uniqueId(word = 'id'): string {
  made += 1
  return `${word}-${made}`
}

/** Collect how to take things down; the returned function does all of it, last first. */
export function cleanup(): { add(...undo: (() => void)[]): void; run(): void } {
  let undos: (() => void)[] = []
  return {
    add: (...more) => void undos.push(...more),
    run() {
      const all = undos.reverse()
      undos = []
      for (const undo of all) undo()
    },
  }
}

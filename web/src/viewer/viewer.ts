import type { Viewer, ViewerOptions } from './contract'

export type { Frame, Show, Theme, Tool, Viewer, ViewerEvents, ViewerOptions } from './contract'

export function createViewer(_element: HTMLElement, _options: ViewerOptions = {}): Viewer {
  throw new Error('not written yet')
}

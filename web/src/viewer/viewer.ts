import type { Scene } from './scene'

export interface Viewer {
  setScenes(scenes: Scene[]): void
  dispose(): void
}

export function createViewer(_element: HTMLElement): Viewer {
  return { setScenes() {}, dispose() {} }
}

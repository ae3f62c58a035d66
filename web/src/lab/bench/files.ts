/** Files in and out: the link, the downloads, and what is dropped on the page. */
import { put } from '../../viewer/elements'
import type { ExportFormat } from '../api'
import { isAbort } from '../api'
import type { App } from '../app'
import { cleanup, h, listen } from '../dom'
import { icon } from '../icons'
import { formatRoute } from '../router'
import { baseName, save } from '../saving'
import type { Scenario } from '../scenario'
import { encode } from '../share'

export { save }

type Choice = ExportFormat | 'stage'

const CHOICES: [Choice, string, string][] = [
  ['toml', 'TOML', 'the scenario, as trundle reads it'],
  ['csv', 'CSV', 'every sample, for a spreadsheet'],
  ['nc', 'NetCDF', 'the run, for xarray and trundle check'],
  ['png', 'PNG figure', 'the paths, in print quality'],
  ['svg', 'SVG figure', 'the same, to be scaled'],
  ['stage', 'PNG of the stage', 'what you see now'],
  ['html', 'HTML', 'a page that plays by itself, to be mailed'],
  ['glb', 'GLB', 'the animation, for 3-D programs'],
  ['gif', 'GIF', 'the animation, for slides'],
]

export async function copyLink(app: App): Promise<void> {
  const code = await encode(app.store.scenario)
  const link = `${location.origin}${location.pathname}${formatRoute('bench', { s: code })}`
  app.router.replace('bench', { s: code })
  try {
    await navigator.clipboard.writeText(link)
    app.toast('Link copied: it holds the whole scenario.')
  } catch {
    // Without a clipboard (plain http elsewhere) the address bar has it.
    app.toast('The link is in the address bar now: copy it from there.')
  }
}

/** The button "Download" and its menu. */
export function createDownloads(app: App, snapshot: () => Promise<Blob>): { element: HTMLElement; dispose(): void } {
  const undo = cleanup()
  const button = h('button', { class: 'button', type: 'button', 'aria-expanded': 'false', 'aria-haspopup': 'true' })
  button.append(icon('download'), h('span', { class: 'button-word' }, 'Download'))
  put(button, 'aria-label', 'Download')
  const items = CHOICES.map(([format, name, what]) => {
    const item = h(
      'button',
      { class: 'menu-item', type: 'button', 'data-format': format },
      h('strong', {}, name),
      h('small', {}, what),
    )
    item.addEventListener('click', () => void take(format, item))
    return item
  })
  const menu = h('div', { class: 'menu', hidden: true, role: 'group', 'aria-label': 'Download as' }, items)
  const element = h('div', { class: 'menu-holder' }, button, menu)

  function open(now: boolean): void {
    menu.hidden = !now
    button.setAttribute('aria-expanded', String(now))
    if (now) items[0]?.focus()
  }
  button.addEventListener('click', () => open(menu.hidden !== false))
  undo.add(
    listen(document, 'pointerdown', (event: Event) => {
      if (event.target instanceof Node && !element.contains(event.target)) open(false)
    }),
  )
  element.addEventListener('keydown', (event) => {
    if (menu.hidden) return
    const at = items.indexOf(document.activeElement as HTMLButtonElement)
    const way = { ArrowDown: 1, ArrowUp: -1 }[event.key]
    if (event.key === 'Escape') {
      open(false)
      button.focus()
    } else if (way !== undefined) items[(at + way + items.length) % items.length]?.focus()
    else return
    event.preventDefault()
    event.stopPropagation()
  })

  async function take(format: Choice, item: HTMLButtonElement): Promise<void> {
    item.setAttribute('aria-busy', 'true')
    try {
      if (format === 'stage') save(await snapshot(), `${baseName(app.store.scenario.title)}-stage.png`)
      else {
        const { blob, name } = await app.api.export(app.store.scenario, format)
        save(blob, name)
      }
      open(false)
    } catch (error) {
      if (!isAbort(error)) app.toast(error instanceof Error ? error.message : String(error), 'error')
    } finally {
      item.removeAttribute('aria-busy')
    }
  }
  return { element, dispose: () => undo.run() }
}

/** By its ending: browsers know no type for either. */
function typed(file: File): Blob {
  const type = /\.(nc|nc4|netcdf)$/i.test(file.name) ? 'application/x-netcdf' : 'application/toml'
  return new Blob([file], { type })
}

async function openFile(app: App, file: File, opened: (scenario: Scenario) => void): Promise<void> {
  try {
    const { scenario } = await app.api.open(typed(file))
    opened(scenario)
    app.toast(`Opened ${file.name}.`)
  } catch (error) {
    if (!isAbort(error)) app.toast(`${file.name}: ${error instanceof Error ? error.message : String(error)}`, 'error')
  }
}

/** The button "Open", and dropping anywhere on the page. */
export function createOpener(
  app: App,
  opened: (scenario: Scenario) => void,
): { element: HTMLElement; dispose(): void } {
  const undo = cleanup()
  const input = h('input', {
    type: 'file',
    accept: '.toml,.nc,.nc4',
    class: 'sr-only',
    tabindex: '-1',
    'aria-label': 'A scenario (TOML) or a run (NetCDF)',
  })
  const button = h('button', {
    class: 'button',
    type: 'button',
    'aria-label': 'Open a file',
    onclick: () => input.click(),
  })
  button.append(icon('open'), h('span', { class: 'button-word' }, 'Open'))
  input.addEventListener('change', () => {
    const file = input.files?.[0]
    input.value = ''
    if (file) void openFile(app, file, opened)
  })
  const veil = h('div', { class: 'drop-veil', hidden: true }, h('p', {}, 'Drop a scenario (.toml) or a run (.nc) here'))
  document.body.append(veil)
  const hasFiles = (event: DragEvent) => event.dataTransfer?.types.includes('Files') ?? false
  undo.add(
    () => veil.remove(),
    listen(window, 'dragover', (event: DragEvent) => {
      if (!hasFiles(event)) return
      event.preventDefault()
      veil.hidden = false
    }),
    listen(window, 'dragleave', (event: DragEvent) => {
      if (event.relatedTarget === null) veil.hidden = true
    }),
    listen(window, 'drop', (event: DragEvent) => {
      if (!hasFiles(event)) return
      event.preventDefault()
      veil.hidden = true
      const file = event.dataTransfer?.files[0]
      if (file) void openFile(app, file, opened)
    }),
  )
  return { element: h('div', { class: 'opener' }, button, input), dispose: () => undo.run() }
}

/** The help dialog: what one can do, and every key. */
import { h } from './dom'
import { icon } from './icons'

const KEYS: [string, [string, string][]][] = [
  [
    'Everywhere',
    [
      ['?', 'This help'],
      ['P', 'Projector mode'],
      ['Shift T', 'Theme: system, light, dark'],
    ],
  ],
  [
    'On the bench',
    [
      ['/', 'Find a scenario'],
      ['Ctrl Z', 'Undo; with Shift, redo'],
      [', and .', 'Fold the left and the right panel'],
      ['S', 'Copy a link to this scenario'],
      ['O', 'Tool: turn the view'],
      ['D', 'Tool: put it somewhere else; arrow keys move it'],
      ['V', 'Tool: draw its first velocity; arrow keys change it'],
      ['N', 'Tool: nudge it while it runs; arrow keys do it'],
      ['Enter', 'Let it go, or throw it, with these tools'],
    ],
  ],
  [
    'The film',
    [
      ['Space', 'Play, pause'],
      ['← →', 'A sample back, a sample on; with Shift a twentieth of the run'],
      ['Home End', 'To the start, to the end'],
      ['[ and ]', 'Slower, faster'],
      ['L', 'Repeat'],
      ['F', 'Whose eyes: room, table, riding along'],
      ['C', 'Camera back to its place'],
      ['T', 'From above'],
      ['B', 'The camera goes with the body'],
      ['U', 'Sound: rolling, slipping, landings'],
      ['1 to 8', 'Arrows, path, axes: shown or not'],
    ],
  ],
  [
    'In a number',
    [
      ['↑ ↓', 'A step up or down; with Shift ten, with Alt a tenth'],
      ['33.3 rpm', 'A number may be typed with a unit: any that the package knows'],
      ['Esc', 'Back to what it was'],
    ],
  ],
]

function row([keys, what]: [string, string]): HTMLElement {
  const caps = keys.split(' ').map((key) => (/^(and|or|to)$/.test(key) ? ` ${key} ` : h('kbd', {}, key)))
  return h('div', { class: 'help-row' }, h('dt', {}, caps), h('dd', {}, what))
}

export function openHelp(): void {
  const close = h('button', { class: 'icon-button', type: 'button', 'aria-label': 'Close' }, icon('close'))
  const dialog = h(
    'dialog',
    { class: 'dialog dialog-help', 'aria-labelledby': 'help-title' },
    h('header', { class: 'dialog-head' }, h('h2', { id: 'help-title' }, 'How to use the lab'), close),
    h(
      'div',
      { class: 'dialog-body' },
      h(
        'p',
        { class: 'lead' },
        'Choose a scenario, change a number, and the package computes the motion anew. Every curve and every figure ' +
          'comes from it; the page only draws. What can be done by hand on the stage can be typed on the left as well.',
      ),
      h(
        'div',
        { class: 'help-groups' },
        KEYS.map(([title, rows]) => h('section', {}, h('h3', {}, title), h('dl', {}, rows.map(row)))),
      ),
    ),
  )
  close.addEventListener('click', () => dialog.close())
  dialog.addEventListener('close', () => dialog.remove())
  dialog.addEventListener('click', (event) => {
    if (event.target === dialog) dialog.close()
  })
  document.body.append(dialog)
  dialog.showModal()
}

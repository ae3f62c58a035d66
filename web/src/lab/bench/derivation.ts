/** The derivation, step by step, in a drawer. */
import { say } from '../../viewer/elements'
import type { Api, Derivation } from '../api'
import { isAbort } from '../api'
import { fill, h } from '../dom'
import { icon } from '../icons'
import { formula } from '../math'
import { paragraph } from '../pages/parts/prose'
import { show } from '../quantity'
import type { Scenario } from '../scenario'

function step(one: Derivation['steps'][number], place: number): HTMLElement {
  return h(
    'li',
    { class: 'step' },
    h(
      'h3',
      {},
      h('span', { class: 'step-number' }, place + 1),
      one.title,
      one.source ? h('span', { class: 'source' }, one.source) : null,
    ),
    one.text && paragraph(one.text),
    one.latex.map((latex) => formula(latex, true)),
  )
}

function content(derivation: Derivation): (HTMLElement | null)[] {
  const numbers = derivation.numbers ?? []
  return [
    derivation.introduction ? paragraph(derivation.introduction, 'lead') : null,
    h('ol', { class: 'steps' }, derivation.steps.map(step)),
    numbers.length === 0
      ? null
      : h(
          'table',
          { class: 'numbers' },
          h('caption', {}, 'With the numbers of this scenario'),
          h(
            'tbody',
            {},
            numbers.map((one) =>
              h(
                'tr',
                {},
                h('th', { scope: 'row' }, one.name || 'with the symbol', ' ', one.symbol ? formula(one.symbol) : null),
                h('td', {}, `${show(one.value, 5)} ${one.unit}`),
              ),
            ),
          ),
        ),
  ]
}

/** Open the drawer and fill it when the server has answered. */
export async function openDerivation(api: Api, scenario: Scenario): Promise<void> {
  const close = h('button', { class: 'icon-button', type: 'button', 'aria-label': 'Close' }, icon('close'))
  const title = h('h2', { id: 'derivation-title' }, 'Derivation')
  const body = h('div', { class: 'dialog-body', tabindex: '0', role: 'region', 'aria-labelledby': 'derivation-title' })
  fill(body, h('p', { class: 'empty working' }, 'Deriving, and proving each line …'))
  const dialog = h(
    'dialog',
    { class: 'dialog drawer', 'aria-labelledby': 'derivation-title' },
    h('header', { class: 'dialog-head' }, title, close),
    body,
  )
  const gone = new AbortController()
  close.addEventListener('click', () => dialog.close())
  dialog.addEventListener('close', () => {
    gone.abort()
    dialog.remove()
  })
  dialog.addEventListener('click', (event) => {
    if (event.target === dialog) dialog.close()
  })
  document.body.append(dialog)
  dialog.showModal()
  try {
    const derivation = await api.derivation(scenario, { signal: gone.signal })
    say(title, derivation.title)
    fill(body, content(derivation))
  } catch (error) {
    if (!isAbort(error))
      fill(body, h('p', { class: 'alert', role: 'alert' }, error instanceof Error ? error.message : String(error)))
  }
}

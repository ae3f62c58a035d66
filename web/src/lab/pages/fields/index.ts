/** The turntable beside the crossed fields: shared controls, one clock, and a dictionary with the current numbers. */
import { say } from '../../../viewer/elements'
import { withPlaces } from '../../../viewer/quantities'
import type { Scene } from '../../../viewer/scene'
import type { Page } from '../../app'
import { cleanup, fill, h } from '../../dom'
import { formula } from '../../math'
import { show as written } from '../../quantity'
import type { Scenario } from '../../scenario'
import { encode } from '../../share'
import { button, choice, slider } from '../parts/controls'
import { paragraph } from '../parts/prose'
import { leaning } from '../parts/scenarios'
import { type ChargeHeader, chargeOf } from './charge'
import { dictionary, type Entry } from './dictionary'
import { createPair } from './pair'

interface Setting {
  rate: number
  tilt: number
  start: 'down' | 'pushed'
}

const STARTS = [
  ['down', 'Put down'],
  ['pushed', 'Pushed'],
] as const

export const fields: Page = {
  mount(host, app) {
    const undo = cleanup()
    let setting: Setting = { rate: 33.3, tilt: 0.2, start: 'down' }
    const values = h('dl', { class: 'field-values' })
    const body = h('tbody')
    const apart = h('p', { class: 'apart', role: 'status', 'data-testid': 'apart' })
    const pair = createPair(app, ({ charge }) => told(charge))
    undo.add(() => pair.dispose())

    function told(charge: Scene): void {
      const header = chargeOf(charge)
      fill(values, ...fieldValues(header))
      fill(body, dictionary(header.table).map(line))
      say(apart, `Greatest distance between the two paths: ${written(header.apart, 2)} m. That is rounding.`)
    }

    function change(part: Partial<Setting>): void {
      setting = { ...setting, ...part }
      pair.ask(scenarioOf(setting))
    }

    const controls = h(
      'div',
      { class: 'knobs' },
      slider({
        label: 'Tilt, electric field',
        min: -0.3,
        max: 0.3,
        step: 0.01,
        value: setting.tilt,
        words: (tilt) => `${withPlaces(tilt, 2)}°`,
        change: (tilt) => change({ tilt }),
        testid: 'fields-tilt',
      }).element,
      slider({
        label: 'Rate of the table, magnetic field',
        min: -78,
        max: 78,
        step: 0.1,
        value: setting.rate,
        words: (rate) => `${withPlaces(rate, 1)} rpm`,
        change: (rate) => change({ rate }),
        testid: 'fields-rate',
      }).element,
      choice('Start', STARTS, 'down', (start) => change({ start })).element,
      button(
        'Make it yours',
        () => void encode(scenarioOf(setting)).then((s) => app.navigate('bench', { s })),
        'quiet',
      ),
    )
    fill(
      host,
      h(
        'div',
        { class: 'lesson fields' },
        h(
          'header',
          { class: 'fields-head' },
          h('p', { class: 'kicker' }, 'Term by term'),
          h('h1', {}, 'The ball and the electron'),
          paragraph(
            'The turning of the table is a magnetic field, the slope an electric one. Neither ball nor charge runs down; both drift across, at the same average height, at the same average potential.',
          ),
        ),
        h('div', { class: 'fields-stages' }, pair.element),
        h('div', { class: 'fields-tools' }, controls, values, apart),
        h(
          'div',
          {
            class: 'fields-table table-scroll',
            tabindex: '0',
            role: 'region',
            'aria-label': 'What corresponds to what',
          },
          table(body),
        ),
      ),
    )
    change({})
    return () => undo.run()
  },
}

function scenarioOf({ rate, tilt, start }: Setting): Scenario {
  const scenario = leaning(tilt, rate)
  if (start === 'down') return scenario
  const side = rate * tilt >= 0 ? -1 : 1
  // Against the drift, so that the path crosses itself.
  return {
    ...scenario,
    title: 'Steel ball pushed on a slightly tilted turntable',
    start: { position: ['0 cm', `${35 * side} cm`], velocity: ['0 cm/s', `${6 * side} cm/s`] },
  }
}

function fieldValues({ E, B, charge }: ChargeHeader): HTMLElement[] {
  const one = (symbol: string, value: number, unit: string) =>
    h(
      'div',
      {},
      h('dt', {}, formula(symbol)),
      h('dd', { class: 'number' }, written(value), h('span', { class: 'unit' }, ` ${unit}`)),
    )
  return [one('q', charge, 'C'), one('B', B[2], 'T'), one('E', E[0], 'V/m')]
}

function table(body: HTMLElement): HTMLElement {
  return h(
    'table',
    { class: 'dictionary', 'data-testid': 'dictionary' },
    h('caption', { class: 'sr-only' }, 'What of the ball is what of the charge'),
    h(
      'thead',
      {},
      h(
        'tr',
        {},
        h('th', { scope: 'col' }, h('span', { class: 'sr-only' }, 'quantity')),
        h('th', { scope: 'col' }, 'Ball on the table'),
        h('th', { scope: 'col' }, 'Charge in the fields'),
      ),
    ),
    body,
  )
}

function line({ name, ball, charge, ballValue, chargeValue, same }: Entry): HTMLElement {
  return h(
    'tr',
    { class: same ? null : 'differs' },
    h('th', { scope: 'row' }, name),
    h('td', {}, side(ball, ballValue)),
    h('td', {}, side(charge, chargeValue)),
  )
}

function side(latex: string, value: string): HTMLElement {
  return h('div', { class: 'entry' }, formula(latex), h('span', { class: 'number' }, value))
}

/** What happens on the way: a list; each leads to its instant. */
import type { Scene } from '../../viewer/scene'
import { fill, h } from '../dom'
import { show } from '../quantity'

export interface Events {
  element: HTMLElement
  update(scene: Scene): void
}

export function createEvents(seek: (time: number) => void): Events {
  const element = h('div', { class: 'events' })
  function update({ header }: Scene): void {
    const { events } = header
    fill(
      element,
      events.length === 0
        ? h('p', { class: 'empty' }, 'It rolls from the first instant to the last: nothing else happens.')
        : h(
            'ol',
            {},
            events.map((event) =>
              h(
                'li',
                {},
                h(
                  'button',
                  { class: `event event-${event.kind}`, type: 'button', onclick: () => seek(event.time) },
                  h('span', { class: 'event-time' }, `${show(event.time)} s`),
                  h('span', {}, event.text.replace(/ at t = \S+ s$/, '')),
                ),
              ),
            ),
          ),
    )
  }
  return { element, update }
}

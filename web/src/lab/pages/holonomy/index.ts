/** Rolling as geometry: by hand, in two orders, home by a loop. #/holonomy, #/holonomy/orders, #/holonomy/loop. */
import { t } from '../../../languages/translate'
import type { App, Page } from '../../app'
import { cleanup, fill, h } from '../../dom'
import { mountHand } from './hand'
import { mountLoop } from './loop'
import { mountTwoOrders } from './two-orders'

type View = (host: HTMLElement, app: App) => () => void

const VIEWS: readonly { id: string; title: string; mount: View }[] = [
  { id: '', title: 'By hand', mount: mountHand },
  { id: 'orders', title: 'Two orders', mount: mountTwoOrders },
  { id: 'loop', title: 'Home by a loop', mount: mountLoop },
]

export const holonomy: Page = {
  mount(host, app) {
    const undo = cleanup()
    const place = h('div', { class: 'holonomy-view' })
    const links = VIEWS.map(({ id, title }) => h('a', { href: `#/holonomy${id && `/${id}`}` }, title))
    let shown = ''
    let takeDown: () => void = () => {}
    fill(host, h('div', { class: 'holonomy' }, h('nav', { class: 'ways', 'aria-label': 'Ways to roll' }, links), place))

    function show(id: string): void {
      const view = VIEWS.find((one) => one.id === id) ?? VIEWS[0]!
      takeDown()
      shown = view.id
      links.forEach((link, i) => {
        if (VIEWS[i] === view) link.setAttribute('aria-current', 'page')
        else link.removeAttribute('aria-current')
      })
      document.title = t(`${view.title} · Holonomy · trundle lab`)
      fill(place)
      takeDown = view.mount(place, app)
    }

    undo.add(() => takeDown())
    undo.add(
      app.router.subscribe(({ page, path }) => {
        if (page === 'holonomy' && (path[0] ?? '') !== shown) show(path[0] ?? '')
      }),
    )
    show(app.route.path[0] ?? '')
    return () => undo.run()
  },
}

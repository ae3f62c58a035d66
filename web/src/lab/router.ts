/** Pages by the hash of the URL: #/bench?s=..., #/tour/3, #/holonomy. Nothing after the # reaches a server. */

export interface Route {
  /** "bench", "tour"; empty for the front door. */
  page: string
  /** What follows: ["3"] of #/tour/3. */
  path: string[]
  params: Readonly<Record<string, string>>
}

export interface Router {
  readonly route: Route
  navigate(route: string, params?: Record<string, string>): void
  /** Change the address without a new entry in the history, and without telling anyone; not while somebody leaves it. */
  replace(route: string, params?: Record<string, string>): void
  subscribe(listener: (route: Route) => void): () => void
}

function unescaped(text: string): string {
  try {
    return decodeURIComponent(text)
  } catch {
    return text
  }
}

export function parseRoute(hash: string): Route {
  const [way = '', query = ''] = hash.replace(/^#?\/?/, '').split('?', 2)
  const [page = '', ...path] = way.split('/').filter(Boolean).map(unescaped)
  return { page, path, params: Object.fromEntries(new URLSearchParams(query)) }
}

export function formatRoute(route: string, params: Record<string, string> = {}): string {
  const query = new URLSearchParams(params).toString()
  return `#/${route.replace(/^[#/]+/, '')}${query ? `?${query}` : ''}`
}

export function createRouter(): Router {
  const listeners = new Set<(route: Route) => void>()
  let known = location.hash
  let route = parseRoute(known)
  window.addEventListener('hashchange', () => {
    known = location.hash
    route = parseRoute(known)
    for (const listener of [...listeners]) listener(route)
  })
  return {
    get route() {
      return route
    },
    navigate(to, params) {
      location.hash = formatRoute(to, params)
    },
    replace(to, params) {
      if (location.hash !== known) return // somebody goes elsewhere, and the event that tells of it is on its way
      history.replaceState(history.state, '', formatRoute(to, params))
      known = location.hash
      route = parseRoute(known)
    },
    subscribe(listener) {
      listeners.add(listener)
      return () => listeners.delete(listener)
    },
  }
}

/** The pages of the lab, in the order of the menu; the first is the front door. */
import type { Entry } from './app'
import { CHALLENGE, NOTES, REPORT, START } from './texts'

export const pages: Entry[] = [
  { id: 'start', title: START.title, aside: true, load: async () => (await import('./pages/start')).start },
  { id: 'bench', title: 'Bench', load: async () => (await import('./bench')).bench },
  { id: 'tour', title: 'Tour', load: async () => (await import('./pages/tour')).tour },
  { id: 'challenges', title: CHALLENGE.title, load: async () => (await import('./pages/challenges')).challenges },
  { id: 'compare', title: 'Compare', load: async () => (await import('./pages/compare')).compare },
  { id: 'fields', title: 'Crossed fields', load: async () => (await import('./pages/fields')).fields },
  { id: 'holonomy', title: 'Holonomy', load: async () => (await import('./pages/holonomy')).holonomy },
  { id: 'maps', title: 'Maps', load: async () => (await import('./pages/maps')).maps },
  { id: 'measure', title: 'Measure', load: async () => (await import('./pages/measure')).measure },
  { id: 'report', title: REPORT.title, aside: true, load: async () => (await import('./pages/challenges')).report },
  { id: 'notes', title: NOTES.title, aside: true, load: async () => (await import('./pages/challenges/notes')).notes },
]

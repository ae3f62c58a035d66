/** The pages of the lab, in the order of the menu; the first is the front door. */
import type { Page } from './app'
import { bench } from './bench'
import { challenges, compare, fields, holonomy, maps, measure, notes, report, start, tour } from './pages'

export const pages: Page[] = [start, bench, tour, challenges, compare, fields, holonomy, maps, measure, report, notes]

/** The pages of the lab, in the order of the menu. */
import type { Page } from './app'
import { bench } from './bench'
import { compare, fields, holonomy, maps, measure, tour } from './pages'

export const pages: Page[] = [bench, tour, compare, fields, holonomy, maps, measure]

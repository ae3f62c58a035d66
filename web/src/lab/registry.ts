/** The pages of the lab, in the order of the menu. */
import type { Page } from './app'
import { bench } from './bench'

export const pages: Page[] = [bench]

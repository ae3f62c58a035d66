/** The lab's icons: one stroke, 20 by 20. */
import { svg } from './dom'

const PATHS = {
  menu: 'M3 5.5h14M3 10h14M3 14.5h14',
  close: 'M5 5l10 10M15 5L5 15',
  search: 'M9 3.5a5.5 5.5 0 1 0 0 11 5.5 5.5 0 0 0 0-11zM13 13l4 4',
  sun: 'M10 6.5a3.5 3.5 0 1 0 0 7 3.5 3.5 0 0 0 0-7zM10 1.5v2M10 16.5v2M1.5 10h2M16.5 10h2M4 4l1.4 1.4M14.6 14.6L16 16M16 4l-1.4 1.4M5.4 14.6L4 16',
  moon: 'M16.5 12A7 7 0 0 1 8 3.5a7 7 0 1 0 8.5 8.5z',
  auto: 'M10 3a7 7 0 1 0 0 14zM10 3a7 7 0 0 1 0 14',
  projector: 'M2.5 4h15v9.5h-15zM7 17h6M10 13.5V17',
  help: 'M7.3 7.4A2.8 2.8 0 1 1 10 11v1.2M10 15v.2M10 1.8a8.2 8.2 0 1 0 0 16.4 8.2 8.2 0 0 0 0-16.4z',
  undo: 'M7 4L3 8l4 4M3.5 8H12a4.5 4.5 0 0 1 0 9h-2',
  redo: 'M13 4l4 4-4 4M16.5 8H8a4.5 4.5 0 0 0 0 9h2',
  link: 'M8.5 11.5a3.2 3.2 0 0 0 4.6 0l3-3a3.2 3.2 0 0 0-4.6-4.6l-1 1M11.5 8.5a3.2 3.2 0 0 0-4.6 0l-3 3a3.2 3.2 0 0 0 4.6 4.6l1-1',
  download: 'M10 3v10M6 9.5l4 4 4-4M3.5 17h13',
  open: 'M10 13V3M6 6.5l4-4 4 4M3.5 17h13',
  orbit: 'M10 6.5a3.5 3.5 0 1 0 0 7 3.5 3.5 0 0 0 0-7zM2 10c0-2 3.6-3.5 8-3.5s8 1.5 8 3.5-3.6 3.5-8 3.5S2 12 2 10z',
  hand: 'M10 2.5v15M2.5 10h15M7.5 5L10 2.5 12.5 5M7.5 15l2.5 2.5 2.5-2.5M5 7.5L2.5 10 5 12.5M15 7.5l2.5 2.5-2.5 2.5',
  arrow: 'M4 16L16 4M8 4h8v8',
  nudge: 'M2.5 10h8M7.5 6.5L11 10l-3.5 3.5M15 6.5a3.5 3.5 0 1 1 0 7',
  left: 'M12 4l-6 6 6 6',
  right: 'M8 4l6 6-6 6',
  sliders: 'M3 6h8M15 6h2M3 14h2M9 14h8M13 4v4M7 12v4',
  chart: 'M3 3v14h14M6 13l3.5-4 3 2.5L17 6',
  check: 'M4 10.5l4 4 8-9',
  cross: 'M5 5l10 10M15 5L5 15',
  book: 'M4 3.5h9.5a2 2 0 0 1 2 2V17H6a2 2 0 0 1-2-2zM4 15a2 2 0 0 1 2-2h9.5',
  top: 'M3 3h14v14H3zM10 7a3 3 0 1 0 0 6 3 3 0 0 0 0-6z',
  home: 'M4 10a6 6 0 1 1 1.8 4.3M4 15v-3.2h3.2',
} as const

export type IconName = keyof typeof PATHS

export function icon(name: IconName): SVGSVGElement {
  return svg('svg', { class: 'icon', viewBox: '0 0 20 20', 'aria-hidden': 'true' }, svg('path', { d: PATHS[name] }))
}

/** The mark: a ball, and the path that it draws on a tilted table that turns. */
export function mark(): SVGSVGElement {
  return svg(
    'svg',
    { class: 'mark', viewBox: '0 0 32 24', 'aria-hidden': 'true' },
    svg('path', {
      class: 'mark-path',
      d: 'M1.5 18.5C4 6.500 12 2.500 14.500 7.500S10 20.500 7.500 16 12 4 20 5',
    }),
    svg('circle', { class: 'mark-ball', cx: 25, cy: 7, r: 5 }),
  )
}

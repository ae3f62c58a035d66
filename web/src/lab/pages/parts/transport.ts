/** One clock for several stages: play, scrub, speed. The first stage leads, the others follow. */
import { put, say } from '../../../viewer/elements'
import type { Viewer } from '../../../viewer/viewer'
import { fill, h, svg, uniqueId } from '../../dom'

export interface Transport {
  readonly element: HTMLElement
  /** After new scenes: the length of the film may have changed. */
  refresh(): void
  dispose(): void
}

const SPEEDS = [0.25, 0.5, 1, 2, 4] as const
const STEPS = 1000
const PLAY = 'M6.5 4.2v11.6L16 10z'
const PAUSE = 'M6.5 4.5v11M13.5 4.5v11'

export function createTransport(leader: Viewer, followers: readonly Viewer[]): Transport {
  const id = uniqueId('time')
  const press = h('button', { type: 'button', class: 'transport-play', 'data-testid': 'transport-play' })
  const range = h('input', {
    id,
    class: 'slider',
    type: 'range',
    min: 0,
    max: STEPS,
    step: 1,
    value: 0,
    'aria-label': 'Time',
  })
  const clock = h('output', { for: id, class: 'transport-clock' })
  const speed = h(
    'select',
    { 'aria-label': 'Speed' },
    SPEEDS.map((one) => h('option', { value: one, selected: one === leader.speed }, `${one}×`)),
  )

  press.addEventListener('click', () => (leader.playing ? leader.pause() : leader.play()))
  range.addEventListener('input', () => {
    leader.pause()
    leader.seek((Number(range.value) / STEPS) * leader.duration)
  })
  speed.addEventListener('change', () => {
    leader.speed = Number(speed.value)
  })

  function follow(): void {
    for (const viewer of followers) viewer.seek(leader.time)
    const share = leader.duration ? leader.time / leader.duration : 0
    range.value = String(Math.round(share * STEPS))
    range.style.setProperty('--to', `${100 * share}%`)
    put(range, 'aria-valuetext', `${leader.time.toFixed(1)} seconds`)
    say(clock, `${leader.time.toFixed(1)} s`)
  }

  function refresh(): void {
    fill(
      press,
      svg('svg', { viewBox: '0 0 20 20', 'aria-hidden': 'true' }, svg('path', { d: leader.playing ? PAUSE : PLAY })),
    )
    put(press, 'aria-label', leader.playing ? 'Pause' : 'Play')
    press.classList.toggle('playing', leader.playing)
    follow()
  }

  const offs = [leader.on('time', follow), leader.on('play', refresh), leader.on('pause', refresh)]
  refresh()
  return {
    element: h('div', { class: 'transport', role: 'group', 'aria-label': 'Playback' }, press, range, clock, speed),
    refresh,
    dispose() {
      for (const off of offs) off()
    },
  }
}

/** Step 1: a cylinder on a slope. Where it is tells how it lies. */

import type { Scene, Triple } from '../../../viewer/scene'
import { slider } from '../parts/controls'
import { column, markAngles, sampleAt, vectorAt } from '../parts/measure'
import { CYLINDER } from '../parts/scenarios'
import { createStage, simulating } from '../parts/stage'
import type { StepMount } from './place'

const RADIUS = 0.03
const FROM_THE_SIDE: Triple = [0.12, -1, 0.16] // so that the slope is seen to fall

export const mountCylinder: StepMount = ({ app, stage: host, controls, numbers, offer }) => {
  const stage = createStage(app, { label: 'A cylinder with a mark on a slope', controls: false, from: FROM_THE_SIDE })
  stage.viewer.show = { gravity: true } // what is upright beside a slope
  host.append(stage.element)
  let scene: Scene | null = null
  let angles: Float64Array = new Float64Array()

  const way = slider({
    label: 'Roll it',
    min: 0,
    max: 1,
    step: 0.001,
    value: 0,
    words: (share) => `${(wayAt(share) * 100).toFixed(1)} cm`,
    change: show,
    testid: 'roll-cylinder',
  })
  controls.append(way.element)

  /** The samples lie evenly in time, the slider in distance: look the sample up. */
  function sampleOf(share: number): number {
    if (!scene) return 0
    const positions = column(scene, 'position')
    const count = column(scene, 'time').length
    const last = vectorAt(positions, count - 1)[0]
    let i = 0
    while (i < count - 1 && vectorAt(positions, i)[0] < share * last) i += 1
    return i
  }

  function wayAt(share: number): number {
    return scene
      ? vectorAt(column(scene, 'position'), sampleOf(share))[0] - vectorAt(column(scene, 'position'), 0)[0]
      : 0
  }

  function show(share: number): void {
    if (!scene) return
    const i = sampleOf(share)
    stage.viewer.seek(column(scene, 'time')[i] ?? 0)
    tell(i)
  }

  function tell(i: number): void {
    if (!scene) return
    const rolled = vectorAt(column(scene, 'position'), i)[0] - vectorAt(column(scene, 'position'), 0)[0]
    const degrees = (angle: number) => `${((angle * 180) / Math.PI).toFixed(1)}°`
    numbers.set([
      {
        name: 'angle turned',
        symbol: '\\phi = x/a',
        predicted: degrees(rolled / RADIUS),
        measured: degrees(angles[i] ?? 0),
      },
    ])
  }

  const live = simulating(app, stage, (found) => {
    scene = found
    angles = markAngles(found)
    stage.viewer.setScenes([found])
    way.set(0.35)
    show(0.35)
  })
  const off = stage.viewer.on('time', () => scene && tell(sampleAt(scene, stage.viewer.time)))
  live.ask(CYLINDER)
  offer(CYLINDER)
  return () => {
    off()
    live.stop()
    stage.dispose()
  }
}

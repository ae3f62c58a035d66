/** What runs in a live page's worker, behind the law that the page holds: motions by the values of the sliders. */
import type { Headline } from '../viewer/scene'
import { type Course, follow } from './course'
import { headlineOf } from './headline'
import type { Law } from './law'

declare const law: Law

export interface Question {
  id: number
  values: number[]
  /** Instants wanted; without them as many as a film needs. */
  times?: number[]
}

export interface Answer {
  id: number
  values: number[]
  course: Course | null
  headline: Headline | null
  failed: string
}

addEventListener('message', ({ data }: MessageEvent<Question>) => {
  const answer: Answer = { id: data.id, values: data.values, course: null, headline: null, failed: '' }
  try {
    answer.course = follow(law, data.values, data.times)
    if (!data.times) answer.headline = headlineOf(answer.course, law)
  } catch (error) {
    answer.failed = error instanceof Error ? error.message : String(error)
  }
  postMessage(answer)
})

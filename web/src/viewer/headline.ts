/** What a run shows in a sentence, and the same number from elsewhere beside it. */
import type { Headline } from './scene'

/** A sentence's first letter, large. */
export const capital = (text: string) => text.charAt(0).toUpperCase() + text.slice(1)

/** The other number beside the headline: "predicted 3.681 cm/s", "a second way gives 2.85 s". */
export function beside({ other, predicted }: Headline): string {
  if (other === null) return ''
  return predicted ? `predicted ${other}` : `a second way gives ${other}`
}

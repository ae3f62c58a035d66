/** What is typed into the box of a slider: a number as people write it, or as the page itself does. */

const SUPERSCRIPTS = '⁰¹²³⁴⁵⁶⁷⁸⁹'
const NUMBER = /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i

/** The number, with or without the unit of the box behind it, in either language; null for anything else. */
export function typedNumber(text: string, ...units: string[]): number | null {
  let said = text.trim()
  const unit = units.find((one) => one !== '' && said.endsWith(one)) ?? ''
  said = said.slice(0, said.length - unit.length)
  said = said
    .replace(/\s/g, '')
    .replace(/[−⁻]/g, '-')
    .replace(/[×x*·]10\^?([-⁰¹²³⁴⁵⁶⁷⁸⁹\d]+)$/, (_, power: string) => `e${power.replace(/[⁰-⁹¹²³]/g, plain)}`)
    .replace(',', '.')
  const number = NUMBER.test(said) ? Number(said) : Number.NaN
  return Number.isFinite(number) ? number : null
}

function plain(superscript: string): string {
  return String(SUPERSCRIPTS.indexOf(superscript))
}

/** What is saved as a file from the page. */
import { h } from './dom'

export function save(blob: Blob, name: string): void {
  const url = URL.createObjectURL(blob)
  const link = h('a', { href: url, download: name })
  document.body.append(link)
  link.click()
  link.remove()
  setTimeout(() => URL.revokeObjectURL(url), 60_000)
}

/** A file's name from a title. */
export function baseName(title = 'trundle'): string {
  const words = title.toLowerCase().normalize('NFKD')
  return (
    words
      .replace(/[^a-z0-9]+/g, '-')
      .replace(/^-|-$/g, '')
      .slice(0, 60) || 'trundle'
  )
}

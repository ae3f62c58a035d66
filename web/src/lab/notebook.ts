/** What a learner predicts, tries and explains: kept in the browser where that is allowed, and shown in the report. */

export interface Found {
  said: string
  value: number
  unit: string
  least: number | null
  most: number | null
  held: boolean
}

export interface Entry {
  title: string
  prediction?: string
  /** What was chosen when it was checked last: "Rate of the table 42 rpm". */
  chosen?: string[]
  answer?: string
  tries?: number
  hints?: number
  right?: boolean
  found?: Found[]
  explained?: string
  /** A picture of the stage, as the address of its data. */
  picture?: string
  /** Where this motion stands on the bench. */
  link?: string
}

export interface Notebook {
  name: string
  group: string
  entries: Record<string, Entry>
}

const KEY = 'trundle.notebook'

export function readNotebook(): Notebook {
  const empty: Notebook = { name: '', group: '', entries: {} }
  try {
    const found = JSON.parse(localStorage.getItem(KEY) ?? '{}') as Partial<Notebook>
    return { ...empty, ...found, entries: { ...found.entries } }
  } catch {
    return empty
  }
}

/** Keep it; without its pictures where there is no room for them. */
export function writeNotebook(notebook: Notebook): void {
  for (const kept of [notebook, withoutPictures(notebook)]) {
    try {
      localStorage.setItem(KEY, JSON.stringify(kept))
      return
    } catch {
      // Full, or forbidden: the lab works without it.
    }
  }
}

function withoutPictures(notebook: Notebook): Notebook {
  const entries = Object.entries(notebook.entries).map(([name, entry]): [string, Entry] => {
    const { picture: _, ...rest } = entry
    return [name, rest]
  })
  return { ...notebook, entries: Object.fromEntries(entries) }
}

/** Change one entry. */
export function note(name: string, title: string, part: Partial<Entry>): Entry {
  const notebook = readNotebook()
  const entry: Entry = { ...notebook.entries[name], title, ...part }
  writeNotebook({ ...notebook, entries: { ...notebook.entries, [name]: entry } })
  return entry
}

export function forget(): void {
  try {
    localStorage.removeItem(KEY)
  } catch {
    // It was never kept.
  }
}

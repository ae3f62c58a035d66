/** A run as the package packs it: a header, and columns of numbers. */
export interface Scene {
  header: { format: number; title: string; duration: number }
}

export function unpack(_bytes: ArrayBuffer | DataView | Uint8Array): Scene {
  throw new Error('not written yet')
}

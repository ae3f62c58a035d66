/** The URL holds the whole scenario: JSON, deflated, in base64url. */
import type { Scenario } from './scenario'

/** A link longer than this is more likely a mistake than a scenario. */
const LONGEST = 64_000
const LARGEST = 1_000_000

export class LinkError extends Error {
  override name = 'LinkError'
}

async function piped(
  bytes: Uint8Array<ArrayBuffer>,
  stream: GenericTransformStream,
  limit = Infinity,
): Promise<Uint8Array> {
  const reader = new Blob([bytes])
    .stream()
    .pipeThrough(stream as ReadableWritablePair<Uint8Array, BufferSource>)
    .getReader()
  const parts: Uint8Array[] = []
  let length = 0
  for (;;) {
    const { done, value } = await reader.read()
    if (done) break
    parts.push(value)
    length += value.length
    if (length > limit) {
      await reader.cancel()
      throw new LinkError('The link unfolds to more than a scenario can be.')
    }
  }
  const whole = new Uint8Array(length)
  let at = 0
  for (const part of parts) {
    whole.set(part, at)
    at += part.length
  }
  return whole
}

function toBase64Url(bytes: Uint8Array): string {
  let text = ''
  for (const byte of bytes) text += String.fromCharCode(byte)
  return btoa(text).replaceAll('+', '-').replaceAll('/', '_').replace(/=+$/, '')
}

function fromBase64Url(text: string): Uint8Array<ArrayBuffer> {
  const plain = atob(text.replaceAll('-', '+').replaceAll('_', '/'))
  return Uint8Array.from(plain, (c) => c.charCodeAt(0))
}

/** The code of a scenario, or of whatever else a page is about, for the URL. */
export async function encode(value: unknown): Promise<string> {
  const bytes = new TextEncoder().encode(JSON.stringify(value))
  return toBase64Url(await piped(bytes, new CompressionStream('deflate-raw')))
}

/** The scenario of a code; throws a LinkError that says what is wrong with the link. */
export async function decode(code: string): Promise<Scenario> {
  const found = await decodeAny(code)
  if (!isScenario(found)) throw new LinkError('The link holds no scenario.')
  return found
}

/** The same of whatever it holds: what that is, the caller has to see. */
export async function decodeAny(code: string): Promise<unknown> {
  if (code.length > LONGEST) throw new LinkError('The link is too long to be a scenario.')
  try {
    const bytes = await piped(fromBase64Url(code.trim()), new DecompressionStream('deflate-raw'), LARGEST)
    return JSON.parse(new TextDecoder('utf-8', { fatal: true }).decode(bytes))
  } catch (error) {
    if (error instanceof LinkError) throw error
    throw new LinkError('The link is damaged: a part of it is missing or was changed on its way.')
  }
}

function isTable(value: unknown): value is Record<string, unknown> {
  return typeof value === 'object' && value !== null && !Array.isArray(value)
}

/** Has it the tables that a scenario has? What they hold is the server's to check. */
export function isScenario(value: unknown): value is Scenario {
  if (!isTable(value)) return false
  if (Array.isArray(value.path)) return isTable(value.body)
  const { body, support, start, run } = value
  return isTable(body) && typeof body.kind === 'string' && isTable(support) && isTable(start) && isTable(run)
}

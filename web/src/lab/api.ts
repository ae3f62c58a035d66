/** Every route of the lab's server, typed. */

import { t } from '../languages/translate'
import type { Scene, Triple, Turn } from '../viewer/scene'
import { unpack } from '../viewer/scene'
import { createLanes } from './lanes'
import { createMeshes } from './meshes'
import type { Found } from './notebook'
import type { Parts } from './parts'
import type { Json, Quantity, Scenario, Table } from './scenario'
import type { TeacherNote } from './texts'

/** What the package says is wrong, and at which key of the scenario ("support.tilt"). */
export class ApiError extends Error {
  constructor(
    message: string,
    readonly key: string | null,
    readonly kind: string,
    readonly status: number,
  ) {
    super(message)
    this.name = 'ApiError'
  }
}

/** True of what a cancelled request throws: a newer one took its place, nothing went wrong. */
export function isAbort(error: unknown): boolean {
  return error instanceof DOMException && error.name === 'AbortError'
}

export interface ScenarioEntry {
  name: string
  title: string
  /** The heading under which it stands. */
  group: string
  summary: string
  support: string
  body: string
  motion: string
  exact: boolean
  /** 1 to 3: how much one must know. */
  level: number
}

export interface ChallengeControl {
  name: string
  label: string
  unit: string
  least: number
  most: number
  step: number
  first: number
}

/** A challenge, as far as a page may know it. */
export interface Challenge {
  name: string
  title: string
  level: number
  summary: string
  task: string
  hints: string[]
  explain: string
  controls: ChallengeControl[]
  prediction: { question: string; choices: string[] }
  answer: { kind: 'run' } | { kind: 'number'; label: string } | { kind: 'choice'; choices: string[] }
  teacher: TeacherNote
  /** Those that move, by name, where there are several or one is hidden. */
  bodies: string[]
}

export interface Judgement {
  right: boolean
  found: Found[]
  explanation: string
}

export type Values = Record<string, number>

export interface NamedScenario {
  name: string
  toml: string
  scenario: Scenario
}

/** One line of the verification card. */
export type CardLine = { [key: string]: Json | undefined }
export type Card = { [key: string]: Json | undefined }

export interface Derivation {
  title: string
  introduction: string
  steps: { title: string; text: string; latex: string[]; source: string | null }[]
  numbers: { name: string; symbol: string; value: number | null; unit: string }[]
}

export type ExportFormat = 'toml' | 'csv' | 'nc' | 'png' | 'svg' | 'html' | 'glb' | 'gif'

export interface Download {
  blob: Blob
  name: string
}

export interface Simulated {
  scene: Scene
  /** From the request leaving to the columns being ready, here. */
  milliseconds: number
}

export interface RequestOptions {
  /** Requests of one lane cancel their elders. Default: one lane a route; null: none. Give your own for several at once. */
  lane?: string | null
  signal?: AbortSignal
}

export interface SimulateOptions extends RequestOptions {
  samples?: number
  card?: boolean
}

export interface RunOptions extends SimulateOptions {
  /** Of a numerical method, relative, for each step; absent: the finest there is. */
  tolerance?: number
  /** False where nothing is drawn over time: a third less is sent. */
  curves?: boolean
  /** A scene that is shown: the meshes that it has are not sent again. */
  like?: Scene | undefined
}

export interface RollRequest {
  radius: Quantity
  curve: { [key: string]: Json | undefined }
}

/** A body at an instant, in the support frame; what follows the contact is for a nudge. */
export interface Instant {
  position: Triple
  contact: Triple
  time: number
  velocity: Triple
  angular_velocity: Triple
  orientation: Turn
  /** The coordinates of the support's own motion, such as angle and rate of a free axle. */
  support: number[]
  /** How high over the support it flies, m; absent while it touches. */
  height?: number
}

export interface StartRequest {
  at: Pick<Instant, 'position' | 'contact'> & Partial<Instant>
  /** With which it is thrown. */
  velocity?: Triple
  /** What is added to its velocity where it goes on. */
  nudge?: Triple
}

/** One side of a map: a number of the scenario and how far it goes, as the file of a sweep says it. */
export interface Span {
  key: string
  from: Quantity
  to: Quantity
  count: number
  scale: 'linear' | 'log'
}

export interface MapRequest {
  scenario: Scenario
  over: [Span, Span]
  measure: string
}

export interface ShippedSweep extends Omit<MapRequest, 'measure'> {
  name: string
  title: string
  notes: string
  /** By name, the first of them the one to begin with. */
  measures: Record<string, string>
}

export interface Sweeps {
  sweeps: ShippedSweep[]
  /** What may be measured: some of it by a formula, of which this is an example. */
  figures: string[]
  colours: { numbers: string[]; classes: string[] }
}

/** A number of a scenario, SI. */
/** What the page calls a number of a scenario. */
export interface Named {
  key: string
  /** The table that it stands in; empty for what stands alone. */
  group: string
  label: string
}

export interface ScenarioNumber extends Named {
  value: number
  unit: string
}

/** A part of a map: fields are counted with the second number running first. */
export interface MapPart {
  shape: [number, number]
  axes: (Named & { unit: string; values: number[] })[]
  unit: string
  /** What the values stand for where they are classes; else empty. */
  classes: string[]
  /** What was run now, and what was found; null: no value. */
  places: number[]
  values: (number | null)[]
  /** Every field, as far as it is known. */
  picture: (number | null)[]
  run: number
  /** How many fields are to be run before the picture gets finer; 0: it is finished. */
  left: number
}

/** Why a scenario cannot start. */
export interface Refused {
  message: string
  key: string | null
}

/** Columns of a track, SI: `t` and what was measured; null where there is no number. */
export type TrackColumns = Record<string, (number | null)[]>

export interface Track {
  title: string
  columns: TrackColumns
  /** Of each column. */
  units: Record<string, string>
  /** How it was read, and what was left out: sentences, in clauses. */
  said: string[][]
  /** By how much a camera may shift all that it sees at one place, m. */
  accuracy: number
  /** Where a film shows the ball, of a track that was followed in one. */
  film?: Followed
  /** A scenario that may be like what was filmed. */
  suggested?: Suggestion
}

export interface Followed {
  /** How many times slower than the world the film runs. */
  slow: number
  /** Where the ball was seen, a place a row, px. */
  pixels: [number, number][]
  /** The camera, for the server to draw the fitted ball with. */
  view: Json
}

/** What the lab says of films. */
export interface FilmBounds {
  /** The most that one may have. */
  bytes: number
  /** How long one is kept that nobody asks for, and followed, s. */
  kept: number
  followed: number
}

/** A film that the lab keeps for a while, under a name of its own. */
export interface KeptFilm {
  film: string
  width: number
  height: number
  /** Pictures a second as it is played, and as they were taken where its file says so. */
  rate: number
  taken: number | null
  /** s */
  length: number
  /** Where its first picture shows the rim of a table, px. */
  rim: [number, number][] | null
}

/** Pictures of a film that the browser cannot play. */
export interface Reel {
  times: number[]
  /** As addresses that hold them. */
  pictures: string[]
  /** From when on there are more, s. */
  next: number | null
}

/** Where a film shows the fitted ball: its outline over the time of the track, px. */
export interface Outlines {
  time: number[]
  outlines: [number, number][][]
}

/** What a file does not say of itself. */
export interface Question {
  key: string
  rule: string
  received: string
  /** To choose from; others may be written. */
  choices: string[]
}

/** A scenario that may be like what was measured, and what is to be found of it. */
export interface Suggestion {
  scenario: Scenario
  free: string[]
}

export interface ExampleTrack extends Suggestion {
  name: string
  title: string
  about: string
  file: string
  content: string
  noise: string
}

export interface Fitted {
  title: string
  answer: 'good' | 'bad' | 'cannot decide'
  verdict: string
  /** Name, value with its error, unit, remark. */
  rows: [string, string, string, string][]
  /** What cannot be known, a sentence each, with the cure. */
  unknown: string[]
  remarks: string[]
  card: boolean
  scenario: Scenario
  /** The scenario as TOML, with the errors as comments. */
  commented: string
  way: Way
  /** What the numbers are called that are not the scenario's. */
  named: Named[]
  /** In the film that was given. */
  seen: Outlines | null
}

/** The way that a fit went, its last frame where it ended. */
export interface Way {
  time: number[]
  columns: string[]
  frames: { reduced: number; share: number; columns: (number | null)[][] }[]
}

export interface FitRequest {
  scenario: Scenario
  columns: TrackColumns
  title: string
  free: string[]
  noise: string | null
  accuracy?: number
  /** The camera of a film. */
  view?: Json
}

export interface Api {
  exampleTracks(options?: RequestOptions): Promise<ExampleTrack[]>
  /** Read a track; `how` says what the file does not. */
  track(
    file: Blob,
    name: string,
    how: Record<string, string>,
    options?: RequestOptions,
  ): Promise<Track | { asks: Question }>
  fit(request: FitRequest, options?: RequestOptions): Promise<Fitted>
  filmBounds(options?: RequestOptions): Promise<FilmBounds>
  keepFilm(file: Blob, name: string, options?: RequestOptions): Promise<KeptFilm>
  dropFilm(film: string): void
  /** The picture at a time of a film. */
  filmPicture(film: string, at: number, options?: RequestOptions): Promise<Blob>
  filmReel(film: string, length: number, begin: number, options?: RequestOptions): Promise<Reel>
  followFilm(film: string, told: { [key: string]: Json }, options?: RequestOptions): Promise<Track>
  /** How much of a film has been followed, from 0 to 1. */
  filmProgress(film: string, options?: RequestOptions): Promise<{ done: number }>
  sweeps(options?: RequestOptions): Promise<Sweeps>
  mapNumbers(scenario: Scenario, options?: RequestOptions): Promise<ScenarioNumber[]>
  /** Go on with a map for about a second. */
  map(request: MapRequest & { places: number[]; values: (number | null)[] }, options?: RequestOptions): Promise<MapPart>
  /** The scenario of one field. */
  mapPoint(
    request: Omit<MapRequest, 'measure'> & { place: number },
    options?: RequestOptions,
  ): Promise<{ scenario: Scenario; toml: string }>
  scenarios(options?: RequestOptions): Promise<ScenarioEntry[]>
  scenario(name: string, options?: RequestOptions): Promise<NamedScenario>
  schema(options?: RequestOptions): Promise<Json>
  /** What a scenario may be made of. */
  parts(options?: RequestOptions): Promise<Parts>
  /** A start made by hand, SI: what changes in it, null where a key goes. */
  start(scenario: Scenario, put: StartRequest, options?: RequestOptions): Promise<Table>
  challenges(options?: RequestOptions): Promise<Challenge[]>
  /** Run what was chosen in a challenge. */
  tried(name: string, values: Values, body: string, options?: SimulateOptions): Promise<Simulated>
  /** Is the answer right? */
  judged(name: string, values: Values, answer: number | string | null, options?: RequestOptions): Promise<Judgement>
  /** Of each scenario why it cannot start; null where it can. */
  possible(scenarios: Scenario[], options?: RequestOptions): Promise<(Refused | null)[]>
  /** Has a worker answered yet, or are they starting? */
  ready(options?: RequestOptions): Promise<{ ready: boolean }>
  simulate(scenario: Scenario, options?: RunOptions): Promise<Simulated>
  card(scenario: Scenario, options?: RequestOptions): Promise<Card>
  derivation(scenario: Scenario, options?: RequestOptions): Promise<Derivation>
  twin(scenario: Scenario, options?: SimulateOptions): Promise<Simulated>
  roll(request: RollRequest, options?: SimulateOptions): Promise<Simulated>
  export(scenario: Scenario, format: ExportFormat, options?: RequestOptions): Promise<Download>
  open(file: Blob, options?: RequestOptions): Promise<{ scenario: Scenario; toml: string }>
  /** Abort what is under way in a lane, or everything. */
  cancel(lane?: string): void
}

export const UNREACHABLE = 'The lab does not answer. Is it still running in its terminal?'

/** What the package says is wrong, and apart from it, for each value that is, the rule, what came instead, and the remedy. */
interface Told extends Refused {
  parts: readonly { key: string; rule: string; received: string; remedy: string }[]
}

/** The same in the language of the page. */
export function saidOf({ message, parts }: Told): string {
  // The package begins with the name of the file, which here is only ever "scenario".
  if (parts.length === 0) return t(message.replace(/^scenario: /, ''))
  const one = ({ key, rule, received, remedy }: Told['parts'][number]) =>
    `${t('`{key}` {rule}; got {received}.', { key, rule: t(rule), received: t(received) })} ${t(remedy)}`.trim()
  return parts.map(one).join('\n')
}

async function failure(response: Response): Promise<ApiError> {
  try {
    const { error } = (await response.json()) as { error: Told & { kind: string } }
    return new ApiError(saidOf(error), error.key ?? null, error.kind, response.status)
  } catch {
    return new ApiError(`The server answered ${response.status} ${response.statusText}.`, null, 'HTTP', response.status)
  }
}

function fileName(response: Response, fallback: string): string {
  const disposition = response.headers.get('content-disposition') ?? ''
  return /filename="?([^";]+)"?/.exec(disposition)?.[1] ?? fallback
}

export function createApi(base = '', ask: typeof fetch = (input, init) => fetch(input, init)): Api {
  const lanes = createLanes()
  const meshes = createMeshes()

  async function request<T>(
    path: string,
    init: RequestInit,
    lane: string | null,
    outer: AbortSignal | undefined,
    read: (response: Response) => Promise<T>,
  ): Promise<T> {
    const { signal, leave } = lanes.enter(lane, outer)
    try {
      const response = await ask(base + path, { ...init, signal })
      if (!response.ok) throw await failure(response)
      const value = await read(response)
      signal.throwIfAborted()
      return value
    } catch (error) {
      if (signal.aborted) throw new DOMException('A newer request took its place.', 'AbortError')
      if (error instanceof ApiError || isAbort(error)) throw error
      if (error instanceof TypeError) throw new ApiError(UNREACHABLE, null, 'Network', 0)
      throw error
    } finally {
      leave()
    }
  }

  const laneOf = (options: RequestOptions, own: string | null) => (options.lane === undefined ? own : options.lane)

  function get<T>(path: string, options: RequestOptions = {}): Promise<T> {
    return request(path, {}, laneOf(options, null), options.signal, (response) => response.json() as Promise<T>)
  }

  function post<T>(
    path: string,
    body: unknown,
    options: RequestOptions,
    own: string | null,
    read: (response: Response) => Promise<T>,
  ): Promise<T> {
    const init = { method: 'POST', headers: { 'content-type': 'application/json' }, body: JSON.stringify(body) }
    return request(path, init, laneOf(options, own), options.signal, read)
  }

  const json = <T>(response: Response) => response.json() as Promise<T>

  function packed(
    path: string,
    body: object,
    options: SimulateOptions,
    own: string,
    complete: (scene: Scene) => Scene = (scene) => scene,
  ): Promise<Simulated> {
    const began = performance.now()
    const { samples, card } = options
    return post(path, { ...body, samples, card }, options, own, async (response) => {
      const scene = complete(unpack(await response.arrayBuffer()))
      return { scene, milliseconds: performance.now() - began }
    })
  }

  return {
    exampleTracks: (options) => get('/api/tracks', options),
    track: (file, name, how, options = {}) =>
      request(
        `/api/track?${new URLSearchParams({ ...how, name })}`,
        { method: 'POST', headers: { 'content-type': 'application/octet-stream' }, body: file },
        laneOf(options, 'track'),
        options.signal,
        json<Track | { asks: Question }>,
      ),
    fit: (asked, options = {}) => post('/api/fit', asked, options, 'fit', json<Fitted>),
    filmBounds: (options) => get('/api/film', options),
    keepFilm: (file, name, options = {}) =>
      request(
        `/api/film?${new URLSearchParams({ name })}`,
        { method: 'POST', headers: { 'content-type': 'application/octet-stream' }, body: file },
        laneOf(options, 'film'),
        options.signal,
        json<KeptFilm>,
      ),
    dropFilm: (film) => void ask(`${base}/api/film/${film}`, { method: 'DELETE', keepalive: true }).catch(() => {}),
    filmPicture: (film, at, options = {}) =>
      request(
        `/api/film/${film}/picture?${new URLSearchParams({ at: String(at) })}`,
        {},
        laneOf(options, 'film-picture'),
        options.signal,
        (response) => response.blob(),
      ),
    filmReel: (film, length, begin, options) =>
      get(`/api/film/${film}/pictures?length=${length}&begin=${begin}`, options),
    followFilm: (film, told, options = {}) => post(`/api/film/${film}/track`, told, options, 'film', json<Track>),
    filmProgress: (film, options) => get(`/api/film/${film}/progress`, options),
    sweeps: (options) => get('/api/sweeps', options),
    mapNumbers: (scenario, options = {}) =>
      post('/api/map/numbers', { scenario }, options, 'map-numbers', json<ScenarioNumber[]>),
    map: (asked, options = {}) => post('/api/map', asked, options, 'map', json<MapPart>),
    mapPoint: (asked, options = {}) =>
      post('/api/map/point', asked, options, 'map-point', json<{ scenario: Scenario; toml: string }>),
    scenarios: (options) => get('/api/scenarios', options),
    scenario: (name, options) => get(`/api/scenarios/${encodeURIComponent(name)}`, options),
    schema: (options) => get('/api/schema', options),
    parts: (options) => get('/api/parts', options),
    start: (scenario, put, options = {}) => post('/api/start', { scenario, ...put }, options, 'start', json<Table>),
    possible: (scenarios, options = {}) =>
      post('/api/possible', { scenarios }, options, 'possible', async (response) => {
        const all = await json<(Told | null)[]>(response)
        return all.map((one) => one && { message: saidOf(one), key: one.key })
      }),
    ready: (options) => get('/api/ready', options),
    challenges: (options) => get('/api/challenges', options),
    tried: (name, values, body, options = {}) =>
      packed(`/api/challenges/${name}/run`, { values, body }, options, 'challenge'),
    judged: (name, values, answer, options = {}) =>
      post(`/api/challenges/${name}/answer`, { values, answer }, options, 'judge', json<Judgement>),
    simulate: (scenario, { tolerance, curves, like, ...options } = {}) => {
      const here = meshes.of(like)
      const asked = { scenario, tolerance, curves, known: [...here.keys()] }
      return packed('/api/simulate', asked, options, 'simulate', (scene) => meshes.completed(scene, here))
    },
    card: (scenario, options = {}) => post('/api/card', { scenario }, options, 'card', json<Card>),
    derivation: (scenario, options = {}) =>
      post('/api/derivation', { scenario }, options, 'derivation', json<Derivation>),
    twin: (scenario, options = {}) => packed('/api/twin', { scenario }, options, 'twin'),
    roll: (body, options = {}) => packed('/api/roll', body, options, 'roll'),
    export: (scenario, format, options = {}) =>
      post('/api/export', { scenario, format }, options, null, async (response) => ({
        blob: await response.blob(),
        name: fileName(response, `trundle.${format}`),
      })),
    open: (file, options = {}) => {
      const type = file.type || 'application/octet-stream'
      const init = { method: 'POST', headers: { 'content-type': type }, body: file }
      return request(
        '/api/open',
        init,
        laneOf(options, 'open'),
        options.signal,
        json<{ scenario: Scenario; toml: string }>,
      )
    },
    cancel: (lane) => lanes.cancel(lane),
  }
}

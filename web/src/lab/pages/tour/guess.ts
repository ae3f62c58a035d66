/** How far a sketched line lies from the ball's path, and what to say about it. Lengths in metres, x down the slope. */

export type Point = readonly [x: number, y: number]

/** Where a line leads, by its ends alone. */
export type Way = 'downhill' | 'uphill' | 'with the drift' | 'against the drift' | 'round' | 'nowhere'

export interface Judgement {
  /** Mean distance between the two lines, each measured from points evenly along the other. */
  mean: number
  /** The same, as a share of the diagonal of the box round the true path. */
  share: number
  guessed: Way
  happened: Way
}

const EVEN_POINTS = 200
/** A line whose ends are nearer than this share of its length has gone round. */
const ROUND = 0.3

export function lengthOf(line: readonly Point[]): number {
  let length = 0
  for (let i = 1; i < line.length; i += 1) length += apart(line[i - 1]!, line[i]!)
  return length
}

/** Points evenly spaced along a line, its ends among them. */
export function evenly(line: readonly Point[], count = EVEN_POINTS): Point[] {
  const total = lengthOf(line)
  if (line.length === 0) return []
  if (total === 0) return [line[0]!]
  const found: Point[] = []
  let before = 0
  let i = 1
  for (let k = 0; k < count; k += 1) {
    const wanted = (total * k) / (count - 1)
    while (i < line.length - 1 && before + apart(line[i - 1]!, line[i]!) < wanted) {
      before += apart(line[i - 1]!, line[i]!)
      i += 1
    }
    const piece = apart(line[i - 1]!, line[i]!)
    const share = piece === 0 ? 0 : Math.min(1, (wanted - before) / piece)
    const [from, to] = [line[i - 1]!, line[i]!]
    found.push([from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])])
  }
  return found
}

/** Mean distance from the points of one line to the other line, averaged over both ways. */
export function meanDistance(a: readonly Point[], b: readonly Point[]): number {
  const one = evenly(a)
  const other = evenly(b)
  return (meanToLine(one, other) + meanToLine(other, one)) / 2
}

/** Where a line leads; `drift` is +1 where the drift goes along +y, −1 along −y. */
export function wayOf(line: readonly Point[], drift: number, small: number): Way {
  const length = lengthOf(line)
  if (line.length < 2 || length < small) return 'nowhere'
  const [first, last] = [line[0]!, line[line.length - 1]!]
  const [x, y] = [last[0] - first[0], last[1] - first[1]]
  if (Math.hypot(x, y) < ROUND * length) return 'round'
  if (Math.abs(x) >= Math.abs(y)) return x > 0 ? 'downhill' : 'uphill'
  return y * drift > 0 ? 'with the drift' : 'against the drift'
}

export function judge(sketch: readonly Point[], truth: readonly Point[], drift: number): Judgement {
  const size = diagonal(truth)
  const mean = meanDistance(sketch, truth)
  const small = size / 20
  return {
    mean,
    share: size > 0 ? mean / size : 0,
    guessed: wayOf(sketch, drift, small),
    happened: wayOf(truth, drift, small),
  }
}

const GUESSED: Record<Way, string> = {
  downhill: 'You sent the ball downhill',
  uphill: 'You sent the ball uphill',
  'with the drift': 'You sent the ball sideways, as it goes',
  'against the drift': 'You sent the ball sideways, to the other side',
  round: 'You sent the ball round and back',
  nowhere: 'You left the ball where it was',
}

/** Two plain sentences: what was guessed, and how far off. */
export function inWords({ mean, share, guessed, happened }: Judgement): string {
  const far = `Your line and the path are ${centimetres(mean)} apart on average`
  if (guessed === happened && share < 0.05) return `${GUESSED[guessed]}. ${far}: that is the path.`
  if (guessed === happened) return `${GUESSED[guessed]}. ${far}: the right way, not yet the arches.`
  return `${GUESSED[guessed]}; it went sideways, along the level. ${far}.`
}

export function centimetres(metres: number): string {
  const value = metres * 100
  return `${value < 1 ? value.toFixed(1) : value.toFixed(0)}\u00a0cm`
}

function apart(a: Point, b: Point): number {
  return Math.hypot(a[0] - b[0], a[1] - b[1])
}

function meanToLine(points: readonly Point[], line: readonly Point[]): number {
  const total = points.reduce((sum, point) => sum + toLine(point, line), 0)
  return points.length ? total / points.length : 0
}

function toLine(point: Point, line: readonly Point[]): number {
  let least = line.length ? apart(point, line[0]!) : 0
  for (let i = 1; i < line.length; i += 1) least = Math.min(least, toPiece(point, line[i - 1]!, line[i]!))
  return least
}

function toPiece(point: Point, from: Point, to: Point): number {
  const [x, y] = [to[0] - from[0], to[1] - from[1]]
  const squared = x * x + y * y
  const along = squared === 0 ? 0 : ((point[0] - from[0]) * x + (point[1] - from[1]) * y) / squared
  const t = Math.max(0, Math.min(1, along))
  return Math.hypot(point[0] - from[0] - t * x, point[1] - from[1] - t * y)
}

function diagonal(line: readonly Point[]): number {
  if (!line.length) return 0
  const xs = line.map(([x]) => x)
  const ys = line.map(([, y]) => y)
  return Math.hypot(Math.max(...xs) - Math.min(...xs), Math.max(...ys) - Math.min(...ys))
}

/** What of the ball is what of the charge: the server's table, with its formulas set properly. */

/** As the server sends it: formulas and values as plain text. */
export interface TableRow {
  name: string
  ball: string
  ball_value: string
  charge: string
  charge_value: string
}

export interface Entry {
  name: string
  ball: string
  charge: string
  ballValue: string
  chargeValue: string
  /** Whether both values read the same. */
  same: boolean
}

/** The server's names of rows, with the two formulas in LaTeX. */
const FORMULAS: Readonly<Record<string, readonly [string, string]>> = {
  mass: ['m', 'm_q'],
  'rate of turning': ['\\kappa = \\tfrac{k}{1+k}\\,\\omega', '-\\,qB/m_q'],
  push: ['\\tfrac{1}{1+k}\\,g\\sin\\alpha', 'qE/m_q'],
  slowing: ['\\gamma', 'C/m_q'],
  'one turn': ['2\\pi/\\kappa', '2\\pi\\,m_q/qB'],
  radius: ['|\\mathbf{v} - \\mathbf{v}_d|/\\kappa', 'm_q|\\mathbf{v} - \\mathbf{v}_d|/qB'],
  drift: ['v_d = g\\sin\\alpha/(k\\omega)', '\\mathbf{E}\\times\\mathbf{B}/B^2'],
}

const NAMES: Readonly<Record<string, string>> = {
  'rate of turning': 'rate of the circles',
  push: 'pull down the slope',
  radius: 'radius of the circles',
  'one turn': 'time of a round',
}

/** Entries of the dictionary; the masses are left out, since only their ratios to force and charge count. */
export function dictionary(rows: readonly TableRow[]): Entry[] {
  return rows
    .filter(({ name }) => name !== 'mass')
    .map((row) => {
      const [ball, charge] = FORMULAS[row.name] ?? [`\\text{${row.ball}}`, `\\text{${row.charge}}`]
      const [ballValue, chargeValue] = [tidied(row.ball_value), tidied(row.charge_value)]
      return {
        name: NAMES[row.name] ?? row.name,
        ball,
        charge,
        ballValue,
        chargeValue,
        same: ballValue === chargeValue,
      }
    })
}

/** Each number of a value to five digits, with a true minus sign: "(0, -0.0368116) m/s" is "(0, −0.036812) m/s". */
export function tidied(value: string): string {
  return value.replace(/-?\d+(?:\.\d+)?(?:e[-+]?\d+)?/gi, (number, at: number) => {
    const before = value[at - 1] ?? ''
    // Not the 2 of m/s2 or of a name.
    if (/[A-Za-z_^/]/.test(before)) return number
    return String(Number(Number(number).toPrecision(5))).replaceAll('-', '−')
  })
}

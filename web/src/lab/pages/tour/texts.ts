/** What the seven steps say. The order of thought is the lecture's; the words are our own. */

export interface StepText {
  /** In the list of steps. */
  short: string
  title: string
  text: string[]
  /** The one thing to do. */
  task: string
  /** Display formulas. */
  formulas: string[]
  question: string
  answer: string[]
}

export const TEXTS: readonly StepText[] = [
  {
    short: 'Cylinder',
    title: 'A cylinder has nothing to hide',
    text: [
      'A cylinder rolls down a slope without slipping. It cannot be steered, and each centimetre of the way turns it by the same angle. So *where it is tells how it lies*, whatever happened in between.',
      'The condition $\\dot x = a\\dot\\phi$ is the rate of something: $x - a\\phi$ stays as it was, and one coordinate can go. Such a constraint is called *holonomic*.',
    ],
    task: 'Drag the slider to and fro. Wherever you stop, the mark’s angle is the way rolled over the radius.',
    formulas: ['\\dot x - a\\,\\dot\\phi = 0 \\quad\\Longrightarrow\\quad x - a\\,\\phi = \\text{const.}'],
    question: 'A cylinder rolls once round inside a hollow one of three times its radius. How many times does it turn?',
    answer: [
      'Twice. The way is three times its circumference, so it turns three times as seen from the line through both axes; but that line itself goes round once, the other way. Here $a\\phi = (b - a)\\theta$: holonomic again.',
    ],
  },
  {
    short: 'Ball',
    title: 'A ball remembers the way',
    text: [
      'A ball with its north pole on top. Roll it a quarter turn east, then a quarter turn north. Then take the same two quarter turns in the other order.',
      'Both times the ball comes to the same spot. The pole does not: once it points east, once north. No formula in $x$ and $y$ can say how the ball lies; one must know which way it came. The constraint looks like the cylinder’s, but it *cannot be integrated*: it is nonholonomic.',
    ],
    task: 'Roll both balls and watch the poles.',
    formulas: ['\\mathbf{V} - a\\,\\mathbf{\\Omega}\\times\\hat n = 0'],
    question: 'Roll the ball round a square of four quarter turns, home to where it began. Is the north pole on top?',
    answer: [
      'No. It was on top at the start and again at the third corner, but at home it points south: the ball has turned by 120° about a diagonal. Any orientation at all can be reached by a suitable loop.',
    ],
  },
  {
    short: 'Push',
    title: 'Push it, and the table pushes back',
    text: [
      'The constraint cannot be integrated, but it can be *differentiated*. Put that into Newton’s law and its partner for rotation, and the unknown reaction $\\mathbf{R}$ of the table drops out. No multipliers.',
      'Pushed at its centre, a ball gains only five sevenths of what a sliding block would: the table pulls back with two sevenths of the push, and that is what turns the ball. Push higher, and the push itself helps to turn it.',
    ],
    task: 'Raise the push. At what height does the table neither pull nor push?',
    formulas: [
      'R_x = \\tfrac57\\,\\frac{K_y}{a} - \\tfrac27\\,F_x, \\qquad m\\,\\dot V_x = \\tfrac57\\Big(F_x + \\frac{K_y}{a}\\Big)',
    ],
    question: 'Now a torque alone, and no force: which way does the table push the ball?',
    answer: [
      'Forward, with five sevenths of $K/a$. Nothing else can: without a force the table is all there is to push. To the eye a torque $Fa$ and a force $F$ make the same motion; only the reaction tells them apart.',
    ],
  },
  {
    short: 'Turntable',
    title: 'The table turns, the ball goes in circles',
    text: [
      'Now the table turns at $\\omega$, and the ball must keep up with whatever is under it: $\\dot{\\mathbf{r}} - a\\,\\mathbf{\\Omega}\\times\\hat n = \\omega\\,\\hat n\\times\\mathbf{r}$. Eliminate as before, and what is left is a steady motion *round a circle*.',
      'The circle may lie anywhere and have any size: that is up to the start. Its rate is not. A solid ball goes at two sevenths of the table’s rate, whatever its size and mass, and takes three and a half turns of the table for a round.',
    ],
    task: 'Change the table’s rate, or drag the ball to another start. What stays the same?',
    formulas: [
      '\\dot{\\mathbf{r}} = \\frac{\\omega}{1 + ma^2/I}\\;\\hat n\\times(\\mathbf{r} - \\mathbf{r}_0)',
      '\\kappa = \\tfrac27\\,\\omega \\qquad (I = \\tfrac25\\,ma^2)',
    ],
    question: 'A hollow ball has its mass further out. Does it go round faster or slower than a solid one?',
    answer: [
      'Faster: at $\\tfrac25$ of the table’s rate instead of $\\tfrac27$. It is harder to spin up or down, and so the table carries it along better. Two balls that look alike can be told apart in one round.',
    ],
  },
  {
    short: 'Nudge',
    title: 'Put it down gently. Then nudge it.',
    text: [
      'Hold the ball over the turning table until it spins as fast as the table runs away beneath it, and let go. *It stays there.* Nothing holds it; its circle has shrunk to a point.',
      'Now nudge it. It goes round a circle of radius $v/\\kappa$ and comes back to where you touched it, again and again. In a lecture hall it goes on so until air and the shortcomings of the table have their way.',
    ],
    task: 'Watch it stay. Then nudge it: draw an arrow from the ball, or use the buttons.',
    formulas: ['\\varrho = \\frac{v}{\\kappa} = \\frac{7}{2}\\,\\frac{v}{\\omega}'],
    question:
      'A ball rides along with the table, 5 cm from the axis, and is let go. Does it fly off? Does it stay on its spot of the table?',
    answer: [
      'Neither. It circles a point on the *other* side of the axis, 12.5 cm from it, with a radius of 17.5 cm, and is back on its spot of the table after seven turns. From twice as far out the circle is twice as large.',
    ],
  },
  {
    short: 'Tilt',
    title: 'Tilt the table. Where does it go?',
    text: [
      'The turning table now leans by 0.3°, five millimetres from edge to edge. A steel ball is put down gently near the rim.',
      'Where will it be in twenty-four seconds? Decide before you look.',
    ],
    task: 'Draw the ball’s path on the table, or pick a guess. Then let go.',
    formulas: [
      '\\dot{\\mathbf{r}} = \\kappa\\;\\hat\\imath\\times\\Big[\\mathbf{r} - \\mathbf{r}_0 + \\frac{ma^2/I}{\\omega}\\,g\\,t\\,\\hat k\\,\\sin\\alpha\\Big]',
      'v_d = \\frac{ma^2}{I}\\,\\frac{g\\sin\\alpha}{\\omega}',
    ],
    question: 'The table turns twice as fast. Does the ball drift faster or slower?',
    answer: [
      'Slower, half as fast: $v_d$ has $\\omega$ below the line. The circles come round twice as often, and each has only half the time to fall. And if the table turned the other way, the ball would drift to the other side.',
    ],
  },
  {
    short: 'Fields',
    title: 'An electron would do the same',
    text: [
      'Put a charge in a magnetic field along the normal and an electric field down the slope. It circles; the field tries to drag it along; it drifts *across*, at the same average potential, as the ball keeps its average height.',
      'This is no likeness but one and the same equation, term by term: $-qB/m$ stands where $\\tfrac27\\omega$ stood, and $qE/m$ in place of the slope’s pull, $\\tfrac57\\,g\\sin\\alpha$.',
    ],
    task: 'Tilt the table further and watch the fields follow. Do the two ever part?',
    formulas: [
      '\\ddot{\\mathbf{r}} = \\kappa\\,\\hat n\\times\\dot{\\mathbf{r}} + \\tfrac57\\,\\mathbf{g}_\\parallel',
      '\\ddot{\\mathbf{r}} = -\\tfrac{q}{m}\\,\\mathbf{B}\\times\\dot{\\mathbf{r}} + \\tfrac{q}{m}\\,\\mathbf{E}',
    ],
    question: 'The ball is thrown level, exactly at the drift. What path does it take?',
    answer: [
      'A straight line, right across a leaning, turning table. A charge does the same at the speed $E/B$, whatever its mass: so physicists pick out particles of one speed.',
    ],
  },
]

/** What the sixth step says once the guess is made. */
export const AFTER_THE_GUESS: readonly string[] = [
  'It goes *sideways*. The ball sets out downhill, is carried round, and comes to rest again as high as it began, a step further along the level. Its circle drifts across the slope at the speed $v_d$, and on average the ball loses no height.',
]

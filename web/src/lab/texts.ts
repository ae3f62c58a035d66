/** The words of the front door, the challenges, the report and the teacher's notes: by them the catalogues in languages/ have other languages. */

export const START = {
  title: 'Start',
  heading: 'Roll a ball, and see what you did not expect',
  lead: 'A ball on a turning table goes round in circles. On a slope that turns it does not roll down. A spinning stone turns back by itself. Take hold of them here, change any number, and compare what you see with what theory says.',
  tour: 'Take the tour',
  tourSaid: 'Seven short steps, from a cylinder to an electron',
  challenges: 'Solve challenges',
  challengesSaid: 'Predict, try, and hand in a report',
  bench: 'Open the bench',
  benchSaid: 'Every scenario, every number',
  pictures: 'Six to begin with',
  teachers: 'For teachers: notes on every step and challenge',
  languages: 'Language',
} as const

/** The six pictures: a scenario that ships, and what is surprising about it. */
export const SIX: readonly (readonly [name: string, caption: string])[] = [
  ['tilted-turntable-put-down', 'The slope pulls it down. It goes sideways.'],
  ['ball-in-a-turning-bowl', 'A bowl turns, and a ball draws a star.'],
  ['rattleback', 'Spin it the wrong way, and it turns back.'],
  ['billiard-swerve', 'No wall, no wind: spin alone bends its way.'],
  ['loop-the-loop', 'How slow may it be and still get round?'],
  ['roll-home-turned', 'It comes home, and is not as it was.'],
]

export const LEVELS = ['', 'easy', 'medium', 'hard'] as const

export const CHALLENGE = {
  title: 'Challenges',
  heading: 'Ten challenges',
  lead: 'First say what you expect. Then try. Each answer is checked on the motion itself, computed by the same law as everywhere here. What you do is kept in this browser, and makes the report that you hand in.',
  all: '← All challenges',
  kicker: (level: string) => `Challenge · ${level}`,
  solved: 'Solved',
  tried: 'Tried',
  predict: 'Predict',
  do: 'Do',
  explain: 'Explain',
  first: 'Say first what you expect: then the controls are yours.',
  hint: (next: number, of: number) => `Show hint ${next} of ${of}`,
  check: 'Check',
  right: 'Right.',
  notYet: 'Not yet.',
  expected: (choice: string) => `You expected: ${choice}.`,
  found: 'What the run shows',
  asked: 'asked',
  shown: 'the run shows',
  held: 'yes',
  missed: 'not yet',
  atLeast: (value: string) => `at least ${value}`,
  atMost: (value: string) => `at most ${value}`,
  between: (low: string, high: string) => `${low} to ${high}`,
  none: 'none',
  answer: 'Your answer',
  number: 'Type a number, such as 0.4.',
  choose: 'Choose one of them first.',
  explainHint: 'In your own words; it goes into your report.',
  report: 'Your report',
  stage: (title: string) => `The motion: ${title}`,
  reading: (time: string, x: string, y: string, speed: string) =>
    `t = ${time} s   x = ${x} cm   y = ${y} cm   speed ${speed} cm/s`,
  unknown: 'There is no such challenge.',
} as const

export const REPORT = {
  title: 'Report',
  heading: 'Report on challenges',
  lead: 'Everything here stays in this browser. Write your name, print the page or save it as PDF, and hand it in.',
  name: 'Name',
  group: 'Class',
  date: 'Date',
  print: 'Print or save as PDF',
  clear: 'Start anew',
  sure: 'Press again to delete all of it',
  empty: 'Nothing yet. Try a challenge: what you predict, do and explain comes here by itself.',
  toChallenges: 'To the challenges',
  prediction: 'Prediction',
  chosen: 'Chosen',
  answer: 'Answer',
  result: 'Result',
  tries: (count: number) => (count === 1 ? 'checked once' : `checked ${count} times`),
  hints: (count: number) => (count === 0 ? 'no hints' : count === 1 ? 'one hint' : `${count} hints`),
  explanation: 'Explanation',
  unexplained: 'Nothing written yet.',
  link: 'Open this motion on the bench',
  picture: (title: string) => `The motion when it was checked last: ${title}`,
} as const

export const NOTES = {
  title: 'Teacher’s notes',
  heading: 'Teacher’s notes',
  lead: 'For each step of the tour and each challenge: what it is for, how long it takes, what pupils usually answer first, and what to put on the table.',
  print: 'Print or save as PDF',
  tour: 'The tour',
  challenges: 'The challenges',
  step: (number: number) => `Step ${number}`,
  aim: 'Aim',
  time: 'Time',
  wrong: 'Usual wrong answers',
  apparatus: 'Apparatus',
} as const

/** What symbols mean, everywhere: by the command, as it is printed, in words. */
export const SYMBOLS: Readonly<Record<string, readonly [sign: string, meaning: string]>> = {
  '\\kappa': ['κ', 'angular rate at which the ball goes round its circle'],
  '\\omega': ['ω', 'angular velocity of the support'],
  '\\Omega': ['Ω', 'angular velocity of the body'],
  k: ['k', 'inertia ratio I/(m a²)'],
  R: ['R', 'contact force, of the support on the body'],
  F: ['F', 'applied force'],
  N: ['N', 'normal force'],
  f: ['f', 'friction force'],
}

/** As the server says it of a challenge. */
export interface TeacherNote {
  aim: string
  time: string
  wrong: readonly string[]
  apparatus: string
}

/** In the order of the tour's steps. */
export const TOUR_NOTES: readonly TeacherNote[] = [
  {
    aim: 'A constraint on velocities that can be integrated: place and angle tell each other.',
    time: '5 min',
    wrong: ['It turns three times inside the hollow cylinder: the line through the axes goes round once, too.'],
    apparatus: 'A tin with a mark on its rim, a ruler; two tins, one in the other.',
  },
  {
    aim: 'The same constraint for a ball cannot be integrated: the order of the ways counts.',
    time: '10 min',
    wrong: [
      'The pole is on top again after a square: after four quarter turns the ball has turned by 120°.',
      'It slipped: let pupils roll it again, slowly, on a cloth.',
    ],
    apparatus: 'A tennis ball with a pin or a dot, squared paper with squares of a quarter of its girth.',
  },
  {
    aim: 'Find the reaction of the table without multipliers; see that friction may push forward.',
    time: '10 min',
    wrong: [
      'Friction always pulls back: pushed above two fifths of the radius over the centre, it pushes forward.',
      'The acceleration is F/m: five sevenths of it, pushed at the centre.',
    ],
    apparatus: 'A ball on a table and a ruler to push it with, at several heights.',
  },
  {
    aim: 'A rate that depends on nothing but the inside of the ball: two sevenths of the table’s.',
    time: '10 min',
    wrong: [
      'The ball is carried round with the table.',
      'A larger or heavier ball goes round more slowly: radius and mass cancel.',
    ],
    apparatus: 'A record player with a glass plate, a steel ball, a table tennis ball, a stopwatch.',
  },
  {
    aim: 'The radius of the circle is the speed over the rate; at rest it is a point.',
    time: '10 min',
    wrong: [
      'It must fly off: nothing pulls it outwards.',
      'After a nudge it goes straight on, as on a table that stands.',
    ],
    apparatus: 'As before; a drinking straw, to nudge the ball with a puff.',
  },
  {
    aim: 'Drift across the slope: commit to a guess, and be surprised.',
    time: '15 min',
    wrong: [
      'Downhill, in widening loops: the usual guess, and good to have on the board before the ball is let go.',
      'Faster turning throws it off faster: the drift falls with the rate.',
    ],
    apparatus: 'As before, with 5 mm of cardboard under one side of the player.',
  },
  {
    aim: 'One equation for two things: a ball on a leaning turntable, and a charge in crossed fields.',
    time: '10 min',
    wrong: ['It is only a likeness: term by term, it is the same equation.'],
    apparatus: 'None; or an electron tube with crossed fields beside the turntable.',
  },
]

/** The pages beside the bench. */
export { challenges, report } from './challenges'
export { notes } from './challenges/notes'
export { compare } from './compare'
export { fields } from './fields'
export { holonomy } from './holonomy'
export { maps } from './maps'
export { start } from './start'
export { tour } from './tour'

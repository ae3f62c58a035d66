/** The pages beside the bench. */
export { compare } from './compare'
export { fields } from './fields'
export { holonomy } from './holonomy'
export { maps } from './maps'
export { measure } from './measure'
export { tour } from './tour'

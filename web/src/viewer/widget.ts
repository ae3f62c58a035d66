import { unpack } from './scene'
import { createViewer } from './viewer'

export { createViewer, unpack }
export default { render() {} }

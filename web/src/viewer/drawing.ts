/** Who draws: a graphics card, or the processor, which takes a hundred times as long for each pixel. */

const PROCESSORS = /swiftshader|llvmpipe|softpipe|lavapipe|software|basic render/i

/** Whether a driver draws by the processor, as in a virtual machine or over a remote desktop. */
export function drawsByProcessor(driver: string): boolean {
  return PROCESSORS.test(driver)
}

/** Whether the processor draws here; to ask takes a canvas of its own, so that a stage can be made as fits the answer. */
export function askWhoDraws(): boolean {
  const gl = document.createElement('canvas').getContext('webgl2', { antialias: false, depth: false })
  if (!gl) return false
  const answer = drawsByProcessor(driverOf(gl))
  gl.getExtension('WEBGL_lose_context')?.loseContext()
  return answer
}

/** The driver's own words for itself; empty where the browser does not tell. */
function driverOf(gl: WebGLRenderingContext | WebGL2RenderingContext): string {
  const told = gl.getExtension('WEBGL_debug_renderer_info')
  const name: unknown = gl.getParameter(told ? told.UNMASKED_RENDERER_WEBGL : gl.RENDERER)
  return typeof name === 'string' ? name : ''
}

/** Who draws: a graphics card, or the processor, which takes a hundred times as long for each pixel. */

const PROCESSORS = /swiftshader|llvmpipe|softpipe|lavapipe|software|basic render/i

/** Whether a driver draws by the processor, as in a virtual machine or over a remote desktop. */
export function drawsByProcessor(driver: string): boolean {
  return PROCESSORS.test(driver)
}

/** The driver's own words for itself; empty where the browser does not tell. */
export function driverOf(gl: WebGLRenderingContext | WebGL2RenderingContext): string {
  const told = gl.getExtension('WEBGL_debug_renderer_info')
  const name: unknown = gl.getParameter(told ? told.UNMASKED_RENDERER_WEBGL : gl.RENDERER)
  return typeof name === 'string' ? name : ''
}

/** Fonts of a widget that stands in a shadow root, as marimo puts it: faces declared in there count for nothing. */

const OURS = /Inter Variable|JetBrains Mono/

/** Declare the viewer's faces, as the root's sheets have them, in the page, once. */
export function liftFonts(within: Element): void {
  const root = within.getRootNode()
  if (!(root instanceof ShadowRoot)) return
  const sheets = [...root.styleSheets, ...root.adoptedStyleSheets]
  const faces = sheets.flatMap((sheet) => [...sheet.cssRules]).filter((rule) => rule instanceof CSSFontFaceRule)
  const own = faces.map((rule) => rule.cssText).filter((face) => OURS.test(face))
  const text = own.join('\n')
  const { head } = document
  if (!text || [...head.querySelectorAll('style[data-trundle]')].some((style) => style.textContent === text)) return
  const style = document.createElement('style')
  style.dataset.trundle = 'fonts'
  style.textContent = text
  head.append(style)
}

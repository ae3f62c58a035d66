/** The picture on the stage, small enough to be kept in the browser. */
import type { Viewer } from '../../../viewer/viewer'

const WIDE = 480 // pixels

export async function thumbnail(viewer: Viewer): Promise<string | null> {
  try {
    const bitmap = await createImageBitmap(await viewer.snapshot())
    const canvas = document.createElement('canvas')
    canvas.width = Math.min(WIDE, bitmap.width)
    canvas.height = Math.round((bitmap.height * canvas.width) / bitmap.width)
    canvas.getContext('2d')?.drawImage(bitmap, 0, 0, canvas.width, canvas.height)
    bitmap.close()
    return canvas.toDataURL('image/jpeg', 0.8)
  } catch {
    return null // without a picture the report still says everything
  }
}

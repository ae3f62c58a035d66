import { describe, expect, it, vi } from 'vitest'
import { ApiError, type MapPart, type MapRequest } from '../../api'
import { createComputing } from './computing'

const REQUEST = { measure: 'end-time' } as MapRequest

/** A map of three fields, one a request. */
function served(fail = false) {
  const asked: { places: number[]; signal?: AbortSignal | undefined }[] = []
  const map = vi.fn(async ({ places }: { places: number[] }, options?: { signal?: AbortSignal }) => {
    asked.push({ places, signal: options?.signal })
    if (fail) throw new ApiError('`measure` must …', 'measure', 'InvalidValueError', 422)
    return { places: [places.length], values: [1], left: 2 - places.length } as MapPart
  })
  return { asked, api: { map } }
}

const listener = () => ({ drawn: vi.fn(), failed: vi.fn(), state: vi.fn() })
const settled = () => new Promise((done) => setTimeout(done))

describe('a map that is computed', () => {
  it('asks with what it knows until nothing is left', async () => {
    const { asked, api } = served()
    const heard = listener()
    const computing = createComputing(api, heard)
    computing.begin(REQUEST)
    await settled()
    expect(asked.map(({ places }) => places)).toEqual([[], [0], [0, 1]])
    expect(heard.drawn).toHaveBeenCalledTimes(3)
    expect(computing.state).toBe('finished')
  })

  it('goes on where it was stopped, and asks for nothing meanwhile', async () => {
    const { asked, api } = served()
    const heard = listener()
    const computing = createComputing(api, heard)
    heard.drawn.mockImplementationOnce(() => computing.stop())
    computing.begin(REQUEST)
    await settled()
    expect(asked[0]?.signal?.aborted).toBe(true)
    const sofar = asked.length
    expect(computing.state).toBe('stopped')
    computing.goOn()
    await settled()
    expect(asked[sofar]?.places).toEqual([0])
    expect(computing.state).toBe('finished')
  })

  it('says what is wrong', async () => {
    const heard = listener()
    const computing = createComputing(served(true).api, heard)
    computing.begin(REQUEST)
    await settled()
    expect(heard.failed).toHaveBeenCalledOnce()
    expect(computing.state).toBe('failed')
  })
})

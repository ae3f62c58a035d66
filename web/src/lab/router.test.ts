import { expect, it, vi } from 'vitest'
import { createRouter, formatRoute, parseRoute } from './router'

it('reads pages, steps and parameters from the hash', () => {
  expect(parseRoute('')).toEqual({ page: '', path: [], params: {} })
  expect(parseRoute('#/tour/3')).toEqual({ page: 'tour', path: ['3'], params: {} })
  expect(parseRoute('#/bench?s=a-_b&name=x')).toEqual({ page: 'bench', path: [], params: { s: 'a-_b', name: 'x' } })
  expect(parseRoute('#/%E0%A4%A/%')).toEqual({ page: '%E0%A4%A', path: ['%'], params: {} })
})

it('writes what it reads', () => {
  expect(parseRoute(formatRoute('tour/3', { guess: 'a b&c' }))).toEqual({
    page: 'tour',
    path: ['3'],
    params: { guess: 'a b&c' },
  })
  expect(formatRoute('#/bench')).toBe('#/bench')
})

it('does not call back who is leaving', async () => {
  location.hash = '#/bench?name=first'
  const router = createRouter()
  const went = vi.fn()
  router.subscribe(went)
  location.hash = '#/bench?name=second'
  router.replace('bench', { name: 'first' }) // the event of the line above has not come yet
  await vi.waitFor(() => expect(router.route.params).toEqual({ name: 'second' }))
  expect(went).toHaveBeenLastCalledWith({ page: 'bench', path: [], params: { name: 'second' } })
  router.replace('bench', { name: 'third' })
  expect(location.hash).toBe('#/bench?name=third')
  expect(router.route.params).toEqual({ name: 'third' })
})

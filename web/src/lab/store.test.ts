import { expect, it } from 'vitest'
import { FIRST } from './first'
import { valueAt, withValue, withValues } from './scenario'
import { createStore } from './store'

const radius = (value: string) => withValue(FIRST, 'body.radius', value)

it('undoes a gesture as one, and redoes it', () => {
  const store = createStore(FIRST)
  store.set(radius('1 cm'), { source: 'control', gesture: 'a' })
  store.set(radius('2 cm'), { source: 'control', gesture: 'a' })
  store.set(radius('3 cm'), { source: 'control', gesture: 'b' })
  expect(store.undo()).toBe(true)
  expect(store.scenario.body.radius).toBe('2 cm')
  store.undo()
  expect(store.scenario).toBe(FIRST)
  expect(store.undo()).toBe(false)
  store.redo()
  store.redo()
  expect(store.scenario.body.radius).toBe('3 cm')
  expect(store.canRedo).toBe(false)
})

it('forgets what was undone once something else is done', () => {
  const store = createStore(FIRST)
  store.set(radius('1 cm'))
  store.undo()
  store.set(radius('2 cm'))
  expect(store.redo()).toBe(false)
})

it('tells every listener until it stops, and nobody of nothing', () => {
  const store = createStore(FIRST)
  const heard: string[] = []
  const stop = store.subscribe((scenario, change) => heard.push(`${scenario.body.radius} ${change.source}`))
  store.set(radius('1 cm'))
  store.set(store.scenario)
  stop()
  store.set(radius('2 cm'))
  expect(heard).toEqual(['1 cm control'])
})

it('cannot undo the first scenario', () => {
  const store = createStore(FIRST)
  store.set(radius('1 cm'), { source: 'first' })
  expect(store.canUndo).toBe(false)
})

it('changes one place and leaves the rest the same', () => {
  const next = withValue(FIRST, 'start.position.1', '3 cm')
  expect(valueAt(next, 'start.position')).toEqual(['-4 cm', '3 cm'])
  expect(valueAt(FIRST, 'start.position.1')).toBe('-45 cm')
  expect(next.body).toBe(FIRST.body)
  expect(withValue(next, 'support.rim', undefined).support).not.toHaveProperty('rim')
  const both = withValues(FIRST, [
    ['loads', [{ kind: 'drag', coefficient: '1 g/s' }]],
    ['loads.0.coefficient', '2 g/s'],
  ])
  expect(both.loads).toEqual([{ kind: 'drag', coefficient: '2 g/s' }])
  expect(valueAt(FIRST, 'loads.0.coefficient')).toBeUndefined()
})

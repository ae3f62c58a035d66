import { expect, test } from 'vitest'
import { moveApart } from './labels'

const box = (x: number, y: number) => ({ x, y, width: 80, height: 20 })

test('names over each other are moved apart, in the order in which they stand', () => {
  const boxes = [box(10, 52), box(0, 50), box(20, 51)]
  moveApart(boxes)
  expect(boxes.map(({ y }) => y)).toEqual([90, 50, 70])
})

test('names beside each other, and far over each other, stay', () => {
  const boxes = [box(0, 50), box(80, 50), box(0, 70)]
  moveApart(boxes)
  expect(boxes.map(({ y }) => y)).toEqual([50, 50, 70])
})

test('what was moved down moves what it comes to lie over', () => {
  const boxes = [box(0, 0), box(60, 5), box(120, 12)]
  moveApart(boxes)
  expect(boxes.map(({ y }) => y)).toEqual([0, 20, 40])
})

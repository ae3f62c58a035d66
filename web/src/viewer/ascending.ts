/** Looking things up in ascending numbers, such as the times of samples. */

/** How many are before a value, or also at it. */
export function countBefore(ascending: ArrayLike<number>, value: number, including = false): number {
  let [low, high] = [0, ascending.length]
  while (low < high) {
    const middle = (low + high) >> 1
    const one = ascending[middle]!
    if (one < value || (including && one === value)) low = middle + 1
    else high = middle
  }
  return low
}

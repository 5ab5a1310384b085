// One of a row of things is chosen by keys.

/**
 * The number to which a key leads from `at`, in 0..last; undefined for other keys.
 * @param {string} key
 * @param {Record<string, number>} steps how far each key goes
 * @param {number} at
 * @param {number} last
 */
export function chosenBy(key, steps, at, last) {
  if (key === "Home") return 0;
  if (key === "End") return last;
  return key in steps ? clamp(at + steps[key], 0, last) : undefined;
}

/**
 * The number of [low, high] nearest to this one.
 * @param {number} value
 * @param {number} low
 * @param {number} high
 */
export function clamp(value, low, high) {
  return Math.max(low, Math.min(high, value));
}

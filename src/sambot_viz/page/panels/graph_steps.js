// @ts-check
/* Which part of the graph an arrow key goes to. */

/** @typedef {{name: string, kind: string, box: [number, number, number, number]}} Box
 *   box: middle and size */

/** @type {Record<string, [number, number]>} */
const WAYS = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};

/** What is nearest in the direction of a key, where what is straight ahead is nearer than what is
 * beside; -1 when nothing is there. @param {Box[]} parts @param {number} from @param {string} key */
export function nearestPart(parts, from, key) {
  const way = WAYS[key];
  if (!way || !parts[from]) return -1;
  const [x, y] = parts[from].box;
  let best = -1;
  let least = Infinity;
  parts.forEach(({ box }, i) => {
    const [dx, dy] = [box[0] - x, box[1] - y];
    const ahead = dx * way[0] + dy * way[1];
    const beside = Math.abs(dx * way[1] + dy * way[0]);
    const far = ahead + 3 * beside;
    if (i !== from && ahead > 1 && far < least) [best, least] = [i, far];
  });
  return best;
}

// @ts-check
/* Studio: names that would cover each other move up or down by whole lines. viser keeps the place
 * of each name in a texture that it writes for every picture: here it is changed before it is
 * drawn. */

/** In which order other places are tried [lines]. */
const PLACES = [0, -1, 1, -2, 2, -3, 3];
/** The part of a name's box that must not be covered. */
const HIGH = 0.85;

/** The line that each name has. @type {Map<number, number>} */
const lines = new Map();
/** Where viser put a name, and we. @type {Map<number, {from: number[], to: number[]}>} */
const moved = new Map();

/** @typedef {{x: number, y: number, w: number, h: number}} Box */
/** @param {Box} a @param {Box} b @param {number} gap */
const meet = (a, b, gap) =>
  Math.abs(a.x - b.x) < (a.w + b.w) / 2 && Math.abs(a.y - b.y) < ((a.h + b.h) / 2) * (1 + gap);

/** The place of a name as viser wrote it. @param {Float32Array} data @param {number} index */
function placeOf(data, index) {
  const now = [...data.subarray(4 * index, 4 * index + 3)];
  const last = moved.get(index);
  return last && last.to.every((v, i) => v === now[i]) ? last.from : now;
}

/**
 * @param {Float32Array} data @param {number} index @param {number[]} from @param {number[]} by
 * @returns {boolean} whether it is elsewhere now
 */
function move(data, index, from, by) {
  const was = [...data.subarray(4 * index, 4 * index + 3)];
  data.set([from[0] + by[0], from[1] + by[1], from[2] + by[2]], 4 * index);
  const to = [...data.subarray(4 * index, 4 * index + 3)];
  moved.set(index, { from, to });
  return to.some((v, i) => v !== was[i]);
}

/**
 * Move the names of a picture apart.
 * @param {any} object the boxes behind all names
 * @param {any} camera
 * @param {boolean} apart false puts them where viser has them
 */
export function moveNames(object, camera, apart) {
  const { aLabelIndex, aRect, aParams } = object.geometry.attributes;
  const texture = object.material.uniforms.uLabelData?.value;
  const data = texture?.image?.data;
  if (!aLabelIndex || !aRect || !aParams || !(data instanceof Float32Array)) return;
  const p = camera.projectionMatrix.elements;
  const v = camera.matrixWorldInverse.elements;
  const up = [...camera.matrixWorld.elements.slice(4, 7)];
  /** @type {Box[]} */
  const placed = [];
  let changed = false;
  for (let i = 0; i < object.geometry.instanceCount; i += 1) {
    const index = aLabelIndex.array[i];
    const scale = aParams.array[2 * i + 1];
    // What has its size on the screen is no name of a frame.
    if (aParams.array[2 * i] > 0.5 || !data[4 * index + 3]) continue;
    const from = placeOf(data, index);
    if (!apart) {
      if (moved.has(index)) changed = move(data, index, from, [0, 0, 0]) || changed;
      continue;
    }
    const [x, y, z] = [0, 1, 2].map(
      (k) => v[k] * from[0] + v[k + 4] * from[1] + v[k + 8] * from[2] + v[k + 12],
    );
    if (z > -1e-6) continue;
    const size = (scale * p[5]) / -z;
    const [left, bottom, width, height] = aRect.array.subarray(4 * i, 4 * i + 4);
    const box = {
      x: (x * p[5]) / -z + (left + width / 2) * size,
      y: (y * p[5]) / -z + (bottom + height / 2) * size,
      w: width * size,
      h: height * size * HIGH,
    };
    const line = height * HIGH;
    const before = lines.get(index);
    const free = PLACES.find((k) =>
      placed.every(
        (other) => !meet({ ...box, y: box.y + k * line * size }, other, k === before ? 0 : 0.15),
      ),
    );
    const at = free ?? 0;
    lines.set(index, at);
    placed.push({ ...box, y: box.y + at * line * size });
    const by = at * line * scale;
    if (at || moved.has(index))
      changed = move(data, index, from, /** @type {number[]} */ (up.map((u) => u * by))) || changed;
  }
  if (!apart) {
    moved.clear();
    lines.clear();
  }
  if (changed) texture.needsUpdate = true;
}

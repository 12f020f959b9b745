// @ts-check
/* Studio: names that would cover each other move up or down, and all of them stand in front of
 * the axes of their frames. viser keeps the place of each name in a texture that it writes for
 * every picture: here it is changed before it is drawn. */

/** Maximum distance of a name from its frame, in heights of the name. */
const FARTHEST = 8;
/** The part of a name's box that must not be covered. */
const HIGH = 0.85;
/** What is left free between two names, as a part of their height. */
const GAP = 0.15;
/** How far a name comes towards the eye, in heights of its box: the axes of a frame are shorter. */
const NEARER = 2;
/** It comes this part of the way at most. */
const NEAREST = 0.5;

/** The name that each name stands beside, and on which side: "" for its own place.
 * @type {Map<number, string>} */
const sides = new Map();
/** Where viser put a name, and we. @type {Map<number, {from: number[], to: number[]}>} */
const moved = new Map();

/** @typedef {{x: number, y: number, w: number, h: number, index: number}} Box */

/**
 * How far each name moves up or down, so that none covers another: as little as it can, and where
 * it was in the picture before rather than elsewhere.
 * @param {Box[]} boxes @param {Map<number, string>} before
 * @returns {{by: number, side: string}[]}
 */
export function apart(boxes, before) {
  /** @type {Box[]} */
  const placed = [];
  return boxes.map((box) => {
    const near = placed.filter((one) => Math.abs(one.x - box.x) < (one.w + box.w) / 2);
    const places = near.flatMap((one) =>
      [1, -1].map((sign) => ({
        by: one.y - box.y + (sign * (1 + GAP) * (one.h + box.h)) / 2,
        side: `${one.index}${sign}`,
      })),
    );
    places.push({ by: 0, side: "" });
    places.sort((a, b) => Math.abs(a.by) - Math.abs(b.by));
    const free = places.find(({ by, side }) => {
      const gap = before.get(box.index) === side ? 0 : 0.99 * GAP;
      return (
        Math.abs(by) <= FARTHEST * box.h &&
        near.every((one) => Math.abs(one.y - box.y - by) >= ((1 + gap) * (one.h + box.h)) / 2)
      );
    });
    const at = free || { by: 0, side: "" };
    placed.push({ ...box, y: box.y + at.by });
    return at;
  });
}

/**
 * The way from a place towards the eye, which leaves it where it is in the picture.
 * @param {number[]} from @param {number[]} eye @param {number} length
 * @returns {number[]}
 */
export function towards(from, eye, length) {
  const way = from.map((v, k) => eye[k] - v);
  const part = Math.min(NEAREST, length / Math.hypot(...way));
  return way.map((v) => v * part);
}

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
 * @param {boolean} on false puts them where viser has them
 */
export function moveNames(object, camera, on) {
  const { aLabelIndex, aRect, aParams } = object.geometry.attributes;
  const texture = object.material.uniforms.uLabelData?.value;
  const data = texture?.image?.data;
  if (!aLabelIndex || !aRect || !aParams || !(data instanceof Float32Array)) return;
  const p = camera.projectionMatrix.elements;
  const v = camera.matrixWorldInverse.elements;
  const up = [...camera.matrixWorld.elements.slice(4, 7)];
  const eye = [...camera.matrixWorld.elements.slice(12, 15)];
  /** @type {(Box & {from: number[], nearer: number[], unit: number})[]} */
  const boxes = [];
  let changed = false;
  for (let i = 0; i < object.geometry.instanceCount; i += 1) {
    const index = aLabelIndex.array[i];
    const scale = aParams.array[2 * i + 1];
    // What has its size on the screen is no name of a frame.
    if (aParams.array[2 * i] > 0.5 || !data[4 * index + 3]) continue;
    const from = placeOf(data, index);
    if (!on) {
      if (moved.has(index)) changed = move(data, index, from, [0, 0, 0]) || changed;
      continue;
    }
    const [left, bottom, width, height] = aRect.array.subarray(4 * i, 4 * i + 4);
    const nearer = towards(from, eye, NEARER * height * scale);
    const at = from.map((value, k) => value + nearer[k]);
    const [x, y, z] = [0, 1, 2].map(
      (k) => v[k] * at[0] + v[k + 4] * at[1] + v[k + 8] * at[2] + v[k + 12],
    );
    if (z > -1e-6) continue;
    const size = (scale * p[5]) / -z;
    boxes.push({
      x: (x * p[5]) / -z + (left + width / 2) * size,
      y: (y * p[5]) / -z + (bottom + height / 2) * size,
      w: width * size,
      h: height * size * HIGH,
      index,
      from,
      nearer,
      unit: scale / size,
    });
  }
  apart(boxes, sides).forEach(({ by, side }, i) => {
    const { index, from, nearer, unit } = boxes[i];
    sides.set(index, side);
    const way = nearer.map((value, k) => value + up[k] * by * unit);
    changed = move(data, index, from, way) || changed;
  });
  if (!on) {
    moved.clear();
    sides.clear();
  }
  if (changed) texture.needsUpdate = true;
}

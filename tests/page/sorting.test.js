/* The order of what can be seen through: from far to near by the distance of the origins. */

import assert from "node:assert/strict";
import { test } from "node:test";

import { farFirst, lookFrom, sortBatch } from "../../src/sambot_viz/page/view/sorting.js";

/** @param {number[]} at */
const matrix = (at) => ({ elements: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, ...at, 1] });
/** @param {number} id @param {number[]} at */
const drawn = (id, at) => ({
  id,
  groupOrder: 0,
  renderOrder: 0,
  object: { matrixWorld: matrix(at) },
});

test("the farther origin is drawn first, and what was made first where they agree", () => {
  lookFrom(matrix([0, 0, 10]));
  // As deep along the view as the second one, and farther to the side.
  const [near, far, again] = [drawn(1, [0, 0, 0]), drawn(2, [5, 0, 0]), drawn(3, [0, 0, 0])];
  assert.deepEqual(
    [again, near, far].sort(farFirst).map(({ id }) => id),
    [2, 1, 3],
  );
});

test("so are the copies of a batch that can be seen through", () => {
  lookFrom(matrix([0, 0, 10]));
  const places = [0, 3, -7, 1];
  /** @type {any} */
  const batch = {
    isInstancedMesh2: true,
    material: { transparent: true },
    matrixWorld: matrix([0, 0, 0]),
    getPositionAt: (/** @type {number} */ index) => ({
      applyMatrix4: () => ({ x: places[index], y: 0, z: 0 }),
    }),
  };
  sortBatch(batch);
  assert.ok(batch.sortObjects);
  const copies = places.map((_, index) => ({ index, depth: 0 }));
  batch.customSort(copies);
  assert.deepEqual(
    copies.map(({ index }) => index),
    [2, 1, 3, 0],
  );
  const opaque = { ...batch, material: { transparent: false }, customSort: null };
  sortBatch(opaque);
  assert.equal(opaque.customSort, null);
});

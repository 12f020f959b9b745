// @ts-check
/* Arrow keys in the graph of nodes and topics. */

import assert from "node:assert/strict";
import { test } from "node:test";
import { nearestPart } from "../../src/sambot_viz/page/panels/graph_steps.js";

/** @param {[number, number][]} places @returns {any[]} */
const parts = (places) => places.map(([x, y]) => ({ box: [x, y, 40, 20] }));

test("an arrow key goes to what is straight ahead before what is nearer beside", () => {
  const all = parts([
    [0, 0],
    [200, 10],
    [100, 90],
    [0, 60],
    [-50, 0],
  ]);
  assert.equal(nearestPart(all, 0, "ArrowRight"), 1);
  assert.equal(nearestPart(all, 0, "ArrowDown"), 3);
  assert.equal(nearestPart(all, 0, "ArrowLeft"), 4);
  assert.equal(nearestPart(all, 1, "ArrowLeft"), 0);
});

test("where nothing is, and for other keys, there is no step", () => {
  const all = parts([[0, 0]]);
  assert.equal(nearestPart(all, 0, "ArrowUp"), -1);
  assert.equal(nearestPart(all, 0, "Enter"), -1);
  assert.equal(nearestPart([], 0, "ArrowUp"), -1);
});

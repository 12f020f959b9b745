import assert from "node:assert/strict";
import { test } from "node:test";
import { unpack } from "../../src/sambot_viz/page/view/maps.js";

test("runs of cells become cells, and cells stay as they are", () => {
  const runs = Uint8Array.from([7, 255, 7, 0, 100, 2]);
  const cells = unpack(runs, 260);
  assert.equal(cells.length, 260);
  assert.ok(cells.subarray(0, 257).every((cell) => cell === 7));
  assert.deepEqual([...cells.subarray(257)], [100, 100, 100]);
  const plain = Uint8Array.from([1, 2, 3, 4]);
  assert.equal(unpack(plain, 4), plain);
});

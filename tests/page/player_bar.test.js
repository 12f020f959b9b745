// @ts-check
import assert from "node:assert/strict";
import { test } from "node:test";
import { clock, timeNow } from "../../src/sambot_viz/page/window/player_bar.js";

test("times are minutes and seconds", () => {
  assert.equal(clock(0), "0:00.0");
  assert.equal(clock(9.96), "0:10.0");
  assert.equal(clock(59.97), "1:00.0");
  assert.equal(clock(3723.4), "62:03.4");
});

test("the time goes on from what was told, and not past the end", () => {
  const told = { value: 2, at: 1000 };
  assert.equal(timeNow(told, 1, 20, 1500), 2.5);
  assert.equal(timeNow(told, 2, 20, 1500), 3);
  assert.equal(timeNow(told, 1, 20, 60000), 20);
  // Clocks may be a little apart.
  assert.equal(timeNow(told, 1, 20, 900), 2);
});

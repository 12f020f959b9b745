// What is said of a place in the queue for control.

import assert from "node:assert/strict";
import { test } from "node:test";

import "./fake_socket.js";

const { timeInWords, turnInWords } = await import("../../src/sambot_viz/page/window/users.js");

test("times and places are said in words", () => {
  const said = [0, 50, 60, 70, 240].map(timeInWords);
  assert.deepEqual(said, ["0 s", "50 s", "1 min", "2 min", "4 min"]);
  const turn = (/** @type {number} */ place) =>
    turnInWords(/** @type {any} */ ({ place, wait: 240 }));
  assert.deepEqual([1, 3, 6].map(turn), ["first, 4 min", "third, 4 min", "number 6, 4 min"]);
});

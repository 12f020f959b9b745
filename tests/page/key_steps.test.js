// Which keys are one step for Undo.

import assert from "node:assert/strict";
import { test } from "node:test";

import { goesOn } from "../../src/sambot_viz/page/cells/key_steps.js";

/** Numbers that look random and are the same in each run. */
function* numbers(seed) {
  for (let n = seed; ;) yield (n = (n * 1103515245 + 12345) % 2 ** 31) / 2 ** 31;
}

test("in any row of keys there is a step for each press, and for each change of what it does", () => {
  const random = numbers(7);
  const chance = () => /** @type {number} */ (random.next().value);
  for (let run = 0; run < 300; run++) {
    const strokes = [];
    let presses = 0;
    for (let i = 0; i < 12; i++) {
      const before = strokes.at(-1);
      // A key is pressed, or the last one is held; Shift may go down or up meanwhile.
      const holds = before && chance() < 0.5;
      const key = holds ? before.key : ["ArrowRight", "PageUp", "Home"][Math.floor(3 * chance())];
      const shiftKey = holds && chance() < 0.7 ? before.shiftKey : chance() < 0.3;
      strokes.push({ key, repeat: Boolean(holds), shiftKey });
      if (!holds || shiftKey !== before.shiftKey) presses++;
    }
    const steps = strokes.filter((stroke, i) => !goesOn(strokes[i - 1], stroke));
    assert.equal(steps.length, presses, JSON.stringify(strokes));
  }
});

test("a key that repeats after another, or after the mouse, begins a step", () => {
  const right = { key: "ArrowRight", repeat: true };
  assert.equal(goesOn({ key: "PageUp" }, right), false);
  assert.equal(goesOn(undefined, right), false);
  assert.equal(goesOn({ key: "ArrowRight" }, right), true);
});

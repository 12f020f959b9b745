import assert from "node:assert/strict";
import { test } from "node:test";
import { fitted } from "../../src/sambot_viz/page/window/sizes.js";

const view = (/** @type {any} */ sizes, /** @type {number} */ width) =>
  (width - sizes.left - sizes.right) / width;

test("panels leave about half of every window to the view", () => {
  for (let width = 1100; width < 2600; width += 50)
    assert.ok(view(fitted({}, width, 800), width) > 0.47, String(width));
  for (let width = 320; width < 1300; width += 50)
    assert.ok(fitted({}, width, 800).side <= 0.52 * width + 1, String(width));
});

test("a panel that a hand has widened keeps its size in that window and in wider ones", () => {
  for (const width of [1280, 1600])
    assert.equal(fitted({ left: 280, right: 600, at: 1280 }, width, 720).right, 600);
});

test("in a narrower window than it was widened in, both sides give way, the wider one more", () => {
  const { left, right } = fitted({ left: 280, right: 600, at: 1280 }, 1150, 720);
  assert.ok(view({ left, right }, 1150) > 0.47);
  assert.ok(left >= 200 && left < 280);
  assert.ok(right < 600 && right > left);
});

test("a side that is folded needs no room", () => {
  assert.equal(fitted({ right: 500, at: 1280 }, 1150, 720, { left: true }).right, 500);
});

test("what is beside or below the view is at most half of a small window", () => {
  const { side, bottom, views } = fitted({ side: 700, bottom: 600, views: 500 }, 853, 480);
  assert.ok(side <= 444 && bottom <= 250 && views <= 250);
});

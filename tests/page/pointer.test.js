// What of the mouse's way over the view is sent.

import assert from "node:assert/strict";
import { mock, test } from "node:test";

class Node {}
const view = new Node();
const box = { left: 0, top: 0, width: 100, height: 100 };
/** @type {Record<string, (event: any) => void>} */
const listeners = {};
Object.assign(globalThis, {
  Node,
  addEventListener: (/** @type {string} */ type, /** @type {any} */ listener) => {
    listeners[type] = listener;
  },
  document: {
    addEventListener() {},
    getElementById: () => ({ contains: () => true, getBoundingClientRect: () => box }),
  },
});
Object.assign(globalThis, { window: globalThis });
mock.timers.enable({ apis: ["setTimeout"] });
let clock = 0;
performance.now = () => clock;
const { followMouse } = await import("../../src/sambot_viz/page/view/pointer.js");

let wanted = false;
const sent = /** @type {{time: number, place: [number, number]}[]} */ ([]);
followMouse({
  wantsHover: () => wanted,
  hover: (place) => sent.push({ time: clock, place }),
  rightClick() {},
  twice() {},
  enter() {},
});

/** Move the mouse to x, a millisecond after the last move [%]. @param {number} x */
function move(x, buttons = 0) {
  listeners.pointermove({ pointerType: "mouse", buttons, target: view, clientX: x, clientY: 50 });
  clock += 1;
  mock.timers.tick(1);
}

/** @param {number} time [ms] */
function rest(time) {
  clock += time;
  mock.timers.tick(time);
}

test("the mouse is reported only while the tool wants it", () => {
  for (let step = 0; step < 100; step++) move(step);
  assert.deepEqual(sent, []);
  wanted = true;
  move(7, 1);
  rest(1000);
  assert.deepEqual(sent, [], "a held button turns the view");
});

test("at most twenty places are sent in a second, and the last place always", () => {
  for (let step = 0; step < 2000; step++) move(step % 90);
  rest(1000);
  const gaps = sent.slice(1).map(({ time }, n) => time - sent[n].time);
  assert.ok(Math.min(...gaps) >= 50, `${Math.min(...gaps)}`);
  assert.ok(sent.length > 30 && sent.length <= 42, `${sent.length}`);
  assert.deepEqual(sent.at(-1)?.place, [(1999 % 90) / 100, 0.5]);
  sent.length = 0;
  move(1999 % 90);
  rest(1000);
  assert.deepEqual(sent, [], "where it has been already");
});

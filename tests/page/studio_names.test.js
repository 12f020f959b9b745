import assert from "node:assert/strict";
import { test } from "node:test";
import { apart, towards } from "../../src/sambot_viz/page/view/studio_names.js";

/** Numbers from 0 to 1 that are the same in every run. */
function* numbers(seed) {
  let state = seed;
  for (;;) {
    state = (state * 1664525 + 1013904223) % 2 ** 32;
    yield state / 2 ** 32;
  }
}

function boxes(seed, count) {
  const random = numbers(seed);
  const next = () => random.next().value;
  return Array.from({ length: count }, (_, index) => ({
    x: next(),
    y: next(),
    w: 0.1 + 0.2 * next(),
    h: 0.02 + 0.04 * next(),
    index,
  }));
}

const shifted = (all, places) => all.map((box, i) => ({ ...box, y: box.y + places[i].by }));

/** The pairs of names that cover each other. */
const covered = (all) =>
  all.flatMap((a, i) =>
    all
      .slice(i + 1)
      .filter(
        (b) => 2 * Math.abs(a.x - b.x) < a.w + b.w && 2 * Math.abs(a.y - b.y) < a.h + b.h - 1e-9,
      ),
  ).length;

test("names of any sizes do not cover each other, as long as there is room", () => {
  let before = 0;
  for (let seed = 1; seed < 40; seed += 1) {
    const all = boxes(seed, 9);
    before += covered(all);
    assert.equal(covered(shifted(all, apart(all, new Map()))), 0, `seed ${seed}`);
  }
  assert.ok(before > 40);
});

test("a name that covers no other stays in its place", () => {
  const all = [
    { x: 0, y: 0, w: 1, h: 0.1, index: 7 },
    { x: 0, y: 1, w: 1, h: 0.1, index: 3 },
    { x: 0, y: 1.01, w: 1, h: 0.05, index: 5 },
  ];
  const [first, second, third] = apart(all, new Map());
  assert.deepEqual([first.by, second.by], [0, 0]);
  assert.ok(third.by > 0 && third.by < 0.1);
});

test("a name stays on its side while the picture moves a little", () => {
  const at = (y) => [
    { x: 0, y: 0, w: 1, h: 0.1, index: 0 },
    { x: 0, y, w: 1, h: 0.1, index: 1 },
  ];
  const [, above] = apart(at(0.01), new Map());
  assert.equal(above.side, "01");
  const sides = new Map([[1, above.side]]);
  // It has just enough room in its own place, and no gap there.
  assert.equal(apart(at(0.105), sides)[1].side, "01");
  assert.equal(apart(at(0.2), sides)[1].side, "");
});

test("one that would have to go far stays", () => {
  const wall = Array.from({ length: 40 }, (_, i) => ({
    x: 0,
    y: (i - 20) * 0.116,
    w: 1,
    h: 0.1,
    index: i,
  }));
  const name = { x: 0, y: 0.03, w: 1, h: 0.1, index: 99 };
  assert.equal(apart([...wall, name], new Map()).at(-1).by, 0);
});

test("a name comes in front of its axes on the line to the eye, half of the way at most", () => {
  assert.deepEqual(towards([1, 0, 0], [1, 0, 4], 1), [0, 0, 1]);
  assert.deepEqual(towards([1, 0, 0], [1, 0, 4], 100), [0, 0, 2]);
});

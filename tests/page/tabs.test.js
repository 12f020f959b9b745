import assert from "node:assert/strict";
import { test } from "node:test";

// What the page's scripts want of a browser when they are read.
Object.assign(globalThis, {
  localStorage: { getItem: () => null, setItem: () => {} },
  matchMedia: () => ({ matches: false, addEventListener: () => {} }),
  addEventListener: () => {},
  document: { addEventListener: () => {}, documentElement: { dataset: {} } },
  innerWidth: 390,
  innerHeight: 844,
});
const { rows } = await import("../../src/sambot_viz/page/wire/channel.js");
const { SHEET, shownTab, tabNames } = await import("../../src/sambot_viz/page/window/panels.js");

/** @param {string[]} names */
const panels = (names) =>
  Object.fromEntries(names.map((name) => [name, [{ id: name, in: "", kind: "float" }]]));
const PARTS = /** @type {[string, string[]][]} */ ([
  ["session", ["joints", "displays", "problems"]],
  ["browser", ["views", "frames", "selection"]],
]);

test("tabs come all at once, whichever part of the window comes first", () => {
  for (const parts of [PARTS, [...PARTS].reverse()]) {
    rows.names.clear();
    rows.panels.clear();
    const seen = parts.map(([scope, names]) => {
      rows.take(scope, { all: true, panels: panels(names) });
      return tabNames(SHEET);
    });
    assert.deepEqual(seen, [
      [],
      ["joints", "displays", "views", "frames", "selection", "problems"],
    ]);
  }
});

test("pictures are in front, else joints, or topics where there is no joint", () => {
  const none = [{ id: "joints/none", in: "", kind: "note" }];
  /** @param {string[]} names @param {any} more */
  const front = (names, more = {}) => {
    rows.names.clear();
    rows.panels.clear();
    for (const [scope, of] of PARTS)
      rows.take(scope, { all: true, panels: { ...panels(of), ...panels(names), ...more } });
    return shownTab(SHEET);
  };
  assert.equal(front([]), "joints");
  assert.equal(front(["topics"]), "joints");
  assert.equal(front(["topics"], { joints: none }), "topics");
  assert.equal(front(["topics", "images"]), "images");
  assert.equal(front(["topics", "images"], { joints: none }), "images");
});

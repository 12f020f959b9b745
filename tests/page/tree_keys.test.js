// Which keys on a selected row begin to replace its value.

import assert from "node:assert/strict";
import { test } from "node:test";

import { edits } from "../../src/sambot_viz/page/tree/row_view.js";
import { treeKey } from "../../src/sambot_viz/page/tree/tree_keys.js";
import { rows, WATCHING } from "../../src/sambot_viz/page/wire/channel.js";

const row = (kind, more = {}) => ({ id: "a", in: "", kind, ...more });

test("letters and digits on a number begin to replace it, so no tool gets them", () => {
  for (const kind of ["int", "float", "slider", "vector"])
    for (const key of "himscnfzrp9-(") assert.ok(edits(row(kind), key), `${kind} ${key}`);
});

test("texts, frames and colours take letters; a box and a list do not", () => {
  for (const kind of ["text", "file", "frame", "color"]) assert.ok(edits(row(kind), "h"), kind);
  for (const kind of ["bool", "display", "enum", "group", "status", "readonly"])
    assert.ok(!edits(row(kind), "h"), kind);
  assert.ok(edits(row("enum", { editable: true }), "h"));
});

test("Space and named keys do not type, Delete does; what cannot be set takes none", () => {
  assert.ok(!edits(row("float"), " "));
  assert.ok(!edits(row("float"), "F2"));
  assert.ok(edits(row("float"), "Delete"));
  assert.ok(!edits(row("float", { fixed: true }), "p"));
  assert.ok(!edits(row("float", { off: true }), "p"));
});

/** Press a key on the row of a number; tells whether its field got the focus, and whether the key
 * is left to the tools. */
function press(key, led) {
  rows.take("session", { all: true, panels: { displays: [{ ...row("float"), value: 0.5 }] } });
  const field = { focused: false, focus: () => (field.focused = true) };
  const event = {
    key,
    left: true,
    target: { matches: () => false, dataset: { row: "a" }, querySelector: () => field },
    preventDefault() {},
    stopPropagation: () => (event.left = false),
  };
  treeKey(event, { ids: ["a"], current: "a", led, go() {}, openMenu() {} });
  return [field.focused, event.left];
}

test("a number that the user was led to is edited by Enter and F2; other keys are for tools", () => {
  assert.deepEqual(press("m", undefined), [true, false]);
  assert.deepEqual(press("m", "a"), [false, true]);
  assert.deepEqual(press("7", "a"), [false, true]);
  for (const key of ["Enter", "F2"]) assert.deepEqual(press(key, "a"), [true, false]);
  assert.deepEqual(press("m", "another"), [true, false]);
});

test("who only watches types into no tool", () => {
  let told = 0;
  const stop = rows.listen(WATCHING, () => (told += 1));
  rows.watch(true);
  assert.deepEqual(press("1", undefined), [false, false]);
  assert.equal(told, 1);
  // Led to the row, and has not touched it: the key is for the view.
  assert.deepEqual(press("1", "a"), [false, true]);
  rows.watch(false);
  stop();
});

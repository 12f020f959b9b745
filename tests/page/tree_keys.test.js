// Which keys on a selected row begin to replace its value.

import assert from "node:assert/strict";
import { test } from "node:test";

import { edits } from "../../src/sambot_viz/page/tree/row_view.js";

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

// What the keys of the window mean.

import assert from "node:assert/strict";
import { test } from "node:test";

import { isTyping, meaning } from "../../src/sambot_viz/page/window/keys.js";

const TOOLS = [
  { name: "Interact", key: "i" },
  { name: "Move Camera", key: "m" },
  { name: "Select", key: "s" },
  { name: "Focus Camera", key: "c" },
  { name: "Measure", key: "n" },
];
const press = (key, more = {}) => meaning({ key, ...more }, TOOLS);

test("the key of a tool presses the tool, with Shift too", () => {
  assert.deepEqual(press("n"), { act: "tools/press", with: ["Measure"] });
  assert.deepEqual(press("S", { shiftKey: true }), { act: "tools/press", with: ["Select"] });
});

test("on a keyboard without Latin letters the place of the key counts", () => {
  assert.deepEqual(press("т", { code: "KeyN" }), { act: "tools/press", with: ["Measure"] });
  assert.equal(press("й", { code: "KeyQ" }), undefined);
});

test("f, z, r, h and Esc act on the view and the window", () => {
  assert.deepEqual(meaning({ key: "f" }, TOOLS, [0.5, 0.25]), {
    act: "tools/focus",
    with: [0.5, 0.25],
  });
  assert.deepEqual(press("z"), { act: "tools/zero" });
  assert.deepEqual(press("r"), { act: "tools/reset" });
  assert.deepEqual(press("Escape"), { act: "tools/escape" });
  assert.equal(press("h"), "hide");
});

test("arrows, Home and End go through a recording, also while they are held", () => {
  assert.deepEqual(press("ArrowLeft", { repeat: true }), { seek: "ArrowLeft" });
  assert.deepEqual(press("End"), { seek: "End" });
  assert.equal(press("Home", { shiftKey: true }), undefined);
  assert.equal(press("ArrowUp"), undefined);
});

test("the digits of a number pad drive the robot, in the Drive panel only", () => {
  const pad = (key) => meaning({ key }, TOOLS, undefined, true);
  for (const key of "2468") {
    assert.deepEqual(pad(key), { act: "drive/press", with: [key] });
    assert.equal(press(key), undefined, key);
  }
  for (const key of "1379") assert.equal(pad(key), undefined, key);
  assert.equal(pad("F8"), undefined);
});

test("1, 3 and 7 look from the front, the right side and the top", () => {
  assert.deepEqual(press("1"), { act: "views/press_side", with: ["front"] });
  assert.deepEqual(press("3"), { act: "views/press_side", with: ["right"] });
  assert.deepEqual(press("7"), { act: "views/press_side", with: ["top"] });
  assert.equal(press("9"), undefined);
});

test("5 stops the robot from anywhere", () => {
  assert.deepEqual(press("5"), { act: "drive/press", with: ["5"] });
  assert.equal(press("F5"), undefined);
});

test("Ctrl+Z undoes, Ctrl+Shift+Z and Ctrl+Y do it again", () => {
  assert.deepEqual(press("z", { ctrlKey: true }), { act: "edit/undo" });
  assert.deepEqual(press("Z", { metaKey: true, shiftKey: true }), { act: "edit/redo" });
  assert.deepEqual(press("y", { ctrlKey: true }), { act: "edit/redo" });
});

test("other keys with Ctrl or Alt are the browser's own", () => {
  for (const key of ["n", "s", "r", "h", "c"]) {
    assert.equal(press(key, { ctrlKey: true }), undefined);
    assert.equal(press(key, { altKey: true }), undefined);
  }
});

test("a key that is held acts once", () => {
  assert.equal(press("n", { repeat: true }), undefined);
  assert.equal(press("h", { repeat: true }), undefined);
  assert.deepEqual(press("z", { ctrlKey: true, repeat: true }), { act: "edit/undo" });
});

test("a text field takes letters; a tick box, a slider and a button do not", () => {
  const input = (type) => ({ tagName: "INPUT", type });
  for (const type of ["text", "search", "number", ""]) assert.ok(isTyping(input(type)), type);
  for (const type of ["checkbox", "range", "color", "radio"])
    assert.ok(!isTyping(input(type)), type);
  for (const tagName of ["TEXTAREA", "SELECT"]) assert.ok(isTyping({ tagName }));
  assert.ok(isTyping({ tagName: "DIV", isContentEditable: true }));
  for (const tagName of ["BUTTON", "CANVAS", "DIV"]) assert.ok(!isTyping({ tagName }));
  assert.ok(!isTyping(null));
});

// Why something was refused: at its place, and in the status bar.

import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { EDITED, rows, send } from "../../src/sambot_viz/page/wire/channel.js";

// A page hears of keys at its window.
const page = new EventTarget();
globalThis.addEventListener = page.addEventListener.bind(page);
const { notice, refusals, refuse, sayRefused, tell } =
  await import("../../src/sambot_viz/page/window/notices.js");

beforeEach(() => {
  notice.set(null);
  refusals.clear();
});

test("a second mistake takes the place of the first", () => {
  sayRefused("frames/add", "name the child frame");
  sayRefused("frames/add", "z: 'abc' is not a number");
  assert.equal(notice.value?.text, "z: 'abc' is not a number");
  assert.equal(refusals.get("frames/add"), "z: 'abc' is not a number");
});

test("what is refused in the page takes away what the server has refused", () => {
  sayRefused("joint/a", "joint/a: there is no such joint");
  refuse("joint/a", "4 rad is outside -1 … 1 rad");
  assert.equal(notice.value, null);
  assert.equal(refusals.get("joint/a"), "4 rad is outside -1 … 1 rad");
});

test("Tab, Escape and typing anywhere end a refusal, other keys do not", () => {
  const end = (type, key) => page.dispatchEvent(Object.assign(new Event(type), { key }));
  for (const [type, key] of [
    ["keydown", "Tab"],
    ["keydown", "Escape"],
    ["input", undefined],
  ]) {
    refuse("joint/a", "'abc' is not a number");
    end("keydown", "Enter");
    assert.equal(refusals.size, 1);
    end(type, key);
    assert.equal(refusals.size, 0, type);
  }
});

test("typing again, or the next edit, ends a refusal", () => {
  sayRefused("frames/add", "name the child frame");
  refuse("frames/add");
  assert.equal(notice.value, null);
  sayRefused("displays/rename", "there is one of this name");
  rows.notify(EDITED);
  assert.equal(notice.value, null);
  assert.equal(refusals.size, 0);
  tell("Saved");
  refuse("joint/a");
  assert.equal(notice.value?.text, "Saved");
});

test("what was said of an edit goes with the next one, but for one that goes on; a warning stays", () => {
  for (const [first, next, level, stays] of [
    ["edit/undo", "joint/a", "ok", false],
    ["edit/undo", "displays/add", "ok", false],
    ["file/save", "g/Alpha", "info", false],
    ["drive/hold", "drive/hold", "ok", true],
    ["drive/hold", "drive/stop", "ok", true],
    ["drive/stop", "joint/a", "ok", false],
    ["edit/undo", "tools/hover", "ok", true],
    ["edit/undo", "frames/show", "ok", true],
    ["edit/undo", "joint/a", "warn", true],
    ["edit/undo", "joint/a", "error", true],
  ]) {
    send(first, []);
    tell("Said", level);
    send(next, 1);
    assert.equal(Boolean(notice.value), stays, `${first}, then ${next}`);
    notice.set(null);
  }
});

test("a row that is gone refuses nothing, nor does another of its name", () => {
  const panels = (...names) => ({
    panels: { joints: names.map((name) => ({ id: `joint/${name}`, in: "", kind: "slider" })) },
  });
  rows.take("session", panels("a", "b"));
  refuse("joint/a", "Enter a number");
  rows.take("session", panels("a"));
  assert.equal(refusals.get("joint/a"), "Enter a number");
  rows.take("session", panels("b"));
  assert.equal(refusals.size, 0);
  sayRefused("joint/b", "joint/b: not now");
  rows.take("session", panels("a"));
  assert.equal(refusals.size, 0);
  assert.equal(notice.value, null);
});

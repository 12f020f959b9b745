// What a page brings back after the program was started again, and what it says is lost.

import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";

import { received, say } from "./fake_socket.js";

// What the page's scripts want of a browser when they are read.
Object.assign(globalThis, { localStorage: { getItem: () => null, setItem: () => {} } });
const { connect, rows } = await import("../../src/sambot_viz/page/wire/channel.js");
const { folds } = await import("../../src/sambot_viz/page/state.js");
const {
  foldsNow,
  hasJoints,
  idsNow,
  jointsToBringBack,
  listed,
  lost,
  otherConfig,
  remember,
  showView,
} = await import("../../src/sambot_viz/page/wire/reconnect.js");

/** @param {string} id @param {string} name @param {string} [above] */
const display = (id, name, above = "") => ({
  id,
  in: above,
  kind: "display",
  name,
  display: "x/Y",
});
/** @param {string} name @param {number} value @param {any} [more] */
const joint = (name, value, more = {}) => ({
  id: `j/${name}`,
  in: "",
  kind: "slider",
  name,
  value,
  min: -3,
  max: 3,
  ...more,
});
/** @param {string} id @param {any} value */
const data = (id, value) => ({ id, in: "", kind: "data", value });
const static_ = (/** @type {string} */ name) => ({
  id: `static/${name}`,
  in: "",
  kind: "readonly",
  name,
  static: true,
});
const again = (/** @type {any} */ first = {}, still = true) => [
  data("joints/first", first),
  data("joints/untouched", still),
];

/** A program with these rows. @param {string} session @param {Record<string, any[]>} panels @param {any} [file] */
function start(session, panels, file = {}) {
  const none = { displays: [], joints: [], joints_again: [], poses: [] };
  rows.take("session", {
    all: true,
    panels: { ...none, names: [data("names/session", { id: session })], ...panels },
  });
  const state = { name: "a.rviz", own: true, folder: "/f", ...file };
  rows.take("browser", {
    all: true,
    panels: {
      files: [data("file/state", state)],
      frames: panels.frames || [],
      selection: panels.selection || [],
    },
  });
}

beforeEach(() => folds.set({}));

test("the page has a connection", async (context) => {
  context.mock.timers.enable({ apis: ["setInterval"] });
  connect();
  await say({ of: "session", all: true });
});

test("joints that were moved come back, the others stay", () => {
  start("1", {
    joints: [joint("a", 1), joint("b", 0.5), joint("c", 0), joint("f", 2, { fixed: true })],
    joints_again: again({ "j/b": 0.5 }),
  });
  const before = remember();
  start("2", {
    joints: [joint("a", 0), joint("b", 0.5), joint("c", 0)],
    joints_again: again({ "j/b": 0.5 }),
  });
  assert.deepEqual(jointsToBringBack(before), [["j/a"], [1]]);
});

test("a joint that starts elsewhere now, has gone, or cannot go there any more, stays", () => {
  start("1", { joints: ["a", "b", "c"].map((name) => joint(name, 1)), joints_again: again() });
  const before = remember();
  start("2", {
    joints: [joint("a", 0.2), joint("c", 0, { max: 0.9 })],
    joints_again: again({ "j/a": 0.2 }),
  });
  assert.deepEqual(jointsToBringBack(before), [[], []]);
});

test("a robot that comes later is waited for", () => {
  start("1", {});
  assert.equal(hasJoints(), false);
  start("1", { joints_again: again() });
  assert.equal(hasJoints(), true);
});

test("the folds of a display follow it to its new number", () => {
  const same = [display("d1", "Grid"), display("d2", "Group"), display("d3", "Grid", "d2")];
  start("1", { displays: [display("d9", "Added"), ...same, display("d4", "Grid")] });
  const before = remember();
  start("2", {
    displays: [
      display("d1", "Group"),
      display("d2", "Grid", "d1"),
      display("d3", "Grid"),
      display("d4", "Grid"),
    ],
  });
  assert.deepEqual(
    foldsNow(before, { d1: true, "d3/Links/=base": true, d9: true, d4: false, options: false }),
    { d3: true, "d2/Links/=base": true, d4: false, options: false },
  );
  assert.deepEqual(["d9/Alpha", "d2", "j/a"].map(idsNow(before)), [null, "d1", "j/a"]);
});

test("what was lost is said, and only that", () => {
  const selection = [{ id: "selected/link/base", in: "", kind: "group" }];
  start(
    "1",
    {
      frames: ["x", "y", "z"].map(static_),
      selection,
      poses: [data("poses/names", ["up", "down"])],
    },
    { modified: true },
  );
  const before = remember();
  assert.deepEqual(lost(before), []);
  start("2", { frames: [static_("z")], poses: [data("poses/names", ["down"])] });
  assert.deepEqual(lost(before), [
    "the static transforms of x and y",
    "the pose up",
    "changes of a.rviz that were not saved",
    "the selection",
  ]);
  // A connection that was interrupted, to the same program.
  start(
    "1",
    { frames: ["x", "y", "z"].map(static_), poses: [data("poses/names", ["up", "down"])] },
    { modified: true },
  );
  assert.deepEqual(lost(before), ["the selection"]);
});

test("the view comes back with all its numbers, or with what the camera does not say", () => {
  const view = (/** @type {string} */ type, /** @type {any[]} */ ...more) => ({
    views: [
      { id: "view/type", in: "", kind: "enum", value: type },
      ...more.map(([id, kind, value]) => ({ id, in: "view", kind, value })),
      { id: "view/:lead", in: "view", kind: "bool", value: true },
      { id: "view/:follow", in: "view", kind: "bool", value: true },
      { id: "views/restore", in: "", kind: "command" },
    ],
  });
  start(
    "1",
    view(
      "Orbit",
      ["view/Yaw", "float", 2],
      ["view/Target Frame", "frame", "<Fixed Frame>"],
      ["view/Invert", "bool", true],
    ),
  );
  const before = remember();
  const following = {
    ...before,
    view: { ...before.view, "view/Target Frame": "base" },
  };
  start("2", view("FPS", ["view/Target Frame", "frame", "odom"]));
  received.length = 0;
  for (const shown of [before, following]) {
    showView(shown);
    showView(shown, false);
  }
  const known = { "view/Target Frame": "<Fixed Frame>", "view/Invert": true };
  // A frame that is followed may be elsewhere now: the numbers are from it.
  const relative = { "view/Yaw": 2, ...known, "view/Target Frame": "base" };
  assert.deepEqual(
    received.map(([id, [type, values]]) => [id, type, JSON.parse(values)]),
    [
      ["views/restore", "Orbit", { "view/Yaw": 2, ...known }],
      ["views/restore", "Orbit", known],
      ["views/restore", "Orbit", relative],
      ["views/restore", "Orbit", relative],
    ],
  );
});

test("a page that only waited for a robot has no view to bring back, but the first one", () => {
  const views = [
    { id: "view/type", in: "", kind: "enum", value: "Orbit" },
    { id: "view/Distance", in: "view", kind: "float", value: 10 },
    data("view/waits", true),
    { id: "views/restore", in: "", kind: "command" },
    { id: "views/first", in: "", kind: "command" },
  ];
  start("1", { views });
  const before = remember();
  start("2", { views });
  received.length = 0;
  // A page that was loaded again begins with it.
  showView(before);
  assert.deepEqual(received, []);
  showView(before, false);
  assert.deepEqual(
    received.map(([id]) => id),
    ["views/first"],
  );
});

test("another config than before is named", () => {
  start("1", {});
  const before = remember();
  assert.equal(otherConfig(before), null);
  start("2", {}, { name: "b.rviz" });
  assert.equal(otherConfig(before)?.name, "a.rviz");
});

test("a list in a sentence is short", () => {
  assert.deepEqual([["a"], ["a", "b"], ["a", "b", "c"], ["a", "b", "c", "d", "e"]].map(listed), [
    "a",
    "a and b",
    "a, b and c",
    "a, b, c and 2 more",
  ]);
});

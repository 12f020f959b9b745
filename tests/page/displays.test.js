import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { received as sent, say } from "./fake_socket.js";

// What the page's scripts want of a browser when they are read.
Object.assign(globalThis, {
  localStorage: { getItem: () => null, setItem: () => {} },
  matchMedia: () => ({ matches: false }),
});
const { connect, rows } = await import("../../src/sambot_viz/page/wire/channel.js");
const { folds } = await import("../../src/sambot_viz/page/state.js");
const { members, moveBy, nearest, neighbour, place, places } =
  await import("../../src/sambot_viz/page/panels/display_order.js");
const { forTopic } = await import("../../src/sambot_viz/page/panels/selected_display.js");

/** @param {string} id @param {string} above @param {any} [more] */
const display = (id, above = "", more = {}) => ({
  id,
  in: above,
  kind: "display",
  name: id,
  display: "x/Y",
  ...more,
});
/** @param {string} id */
const get = (id) => /** @type {any} */ (rows.get(id));

/** a, a group g with p and q, b; every row is 10 high, in the order of the page. */
beforeEach(() => {
  folds.set({});
  rows.take("session", {
    all: true,
    panels: {
      displays: [
        { id: "options", in: "", kind: "group", name: "Global Options" },
        display("a"),
        { id: "a/x", in: "a", kind: "float", name: "x", value: 1 },
        display("g", "", { group: true, open: true }),
        display("p", "g"),
        display("q", "g"),
        display("b"),
      ],
    },
  });
});

/** @param {string[]} shown */
const boxes = (shown) => (/** @type {string} */ id) => {
  const at = shown.indexOf(id);
  return at < 0 ? null : { top: at * 10, bottom: at * 10 + 10 };
};

test("only displays have places among displays", () => {
  assert.deepEqual(members(""), ["a", "g", "b"]);
  assert.deepEqual(members("g"), ["p", "q"]);
});

test("one place down goes into an open group, through it and out of it", () => {
  assert.deepEqual(place(get("a"), 1), { group: "g", index: 0 });
  assert.deepEqual(place(get("p"), 1), { group: "g", index: 1 });
  assert.deepEqual(place(get("q"), 1), { group: "", index: 2 });
  assert.equal(place(get("b"), 1), null);
});

test("one place up goes the same way back", () => {
  assert.deepEqual(place(get("b"), -1), { group: "g", index: 2 });
  assert.deepEqual(place(get("p"), -1), { group: "", index: 1 });
  assert.equal(place(get("a"), -1), null);
});

test("a folded group is passed in one step", () => {
  folds.set({ g: false });
  assert.deepEqual(place(get("a"), 1), { group: "", index: 1 });
  assert.deepEqual(place(get("b"), -1), { group: "", index: 1 });
});

test("after a removal the next display is selected, else the one before, else the group", () => {
  assert.equal(neighbour(get("a")), "g");
  assert.equal(neighbour(get("b")), "g");
  rows.take("session", {
    panels: { displays: [display("g", "", { group: true }), display("p", "g")] },
  });
  assert.equal(neighbour(get("p")), "g");
});

test("of two steps in quick succession the second waits for the first", async (context) => {
  context.mock.timers.enable({ apis: ["setInterval"] });
  connect();
  await say({ of: "browser", all: true });
  const order = (/** @type {string[]} */ ...ids) =>
    rows.take("session", {
      panels: {
        displays: [
          ...ids.map((id) => display(id)),
          { id: "displays/move", in: "", kind: "command" },
        ],
      },
    });
  order("a", "b", "c");
  moveBy("c", -1);
  moveBy("c", -1);
  moveBy("c", -1);
  assert.deepEqual(sent, [["displays/move", ["c", "", 1]]]);
  order("a", "c", "b");
  assert.deepEqual(sent.slice(1), [["displays/move", ["c", "", 0]]]);
  order("c", "a", "b");
  // At the top, the third has nothing to do, and what comes later does not wait for it.
  moveBy("a", 1);
  assert.deepEqual(sent.slice(2), [["displays/move", ["a", "", 2]]]);
  order("c", "b", "a");
});

test("a dragged display can go before and behind each other one, and into groups", () => {
  const found = places("a", boxes(["options", "a", "g", "p", "q", "b"]));
  assert.deepEqual(
    found.map(({ group, index, y }) => [group, index, y]),
    [
      ["", 0, 20],
      ["g", 0, 30],
      ["g", 1, 40],
      ["g", 2, 50],
      ["", 1, 50],
      ["", 2, 60],
    ],
  );
});

test("a topic has a place before and behind each display", () => {
  const found = places("", boxes(["options", "a", "g", "p", "q", "b"]));
  assert.deepEqual(
    found.filter(({ group }) => !group).map(({ index, y }) => [index, y]),
    [
      [0, 10],
      [1, 20],
      [2, 50],
      [3, 60],
    ],
  );
  assert.deepEqual(forTopic("/scan", "", "", found[0]), ["", "/scan", "", "", 0]);
  assert.deepEqual(forTopic("/scan", "x/Y", "Mine"), ["x/Y", "/scan", "Mine", "", null]);
});

test("a folded group takes a display on its row", () => {
  folds.set({ g: false });
  const into = places("a", boxes(["options", "a", "g", "b"])).filter((one) => one.into);
  assert.deepEqual(
    into.map(({ group, index, y, into: row }) => [group, index, y, row]),
    [["g", 2, 25, "g"]],
  );
});

test("a group does not go into itself", () => {
  const found = places("g", boxes(["options", "a", "g", "p", "q", "b"]));
  assert.ok(found.every(({ group }) => group === ""));
});

test("of two places at one line the hand's distance from the left decides", () => {
  const found = places("a", boxes(["options", "a", "g", "p", "q", "b"]));
  assert.equal(nearest(found, 2, 51, 14)?.group, "");
  assert.equal(nearest(found, 20, 51, 14)?.group, "g");
});

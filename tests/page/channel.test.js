// What happens to edits when the connection is lost.

import assert from "node:assert/strict";
import { test } from "node:test";

/** @type {any[]} */
let received = [];
const works = (/** @type {any} */ message) => received.push(message.updates.value);
const fails = () => {
  /* Tried to send, but the websocket is not connected! */
};
const page = { sendMessage: works };
Object.assign(globalThis, { window: { __viserMutable: page } });

const { act, connect, CUT, goOffline, goOnline, NOT_DONE, rows, send, sendHeldBack } =
  await import("../../src/sambot_viz/page/wire/channel.js");

rows.take("session", "rows", {
  base: 0,
  panels: {
    p: [
      { id: "a", in: "", kind: "float", value: 0 },
      { id: "b", in: "", kind: "float", value: 0 },
      { id: "c", in: "", kind: "color", value: [0, 0, 0] },
      { id: "do", in: "", kind: "command" },
      { id: "p/unfold", in: "", kind: "command" },
    ],
  },
});
/** @type {string[]} */
const heard = [];
for (const key of [CUT, NOT_DONE]) rows.listen(key, () => heard.push(key));
rows.listen(CUT, goOffline);
const back = () => {
  goOnline();
  return sendHeldBack();
};

test("an edit of the first moment without a connection is kept, and an action says that it is not done", () => {
  send("a", 1);
  assert.deepEqual(received, [["a", 1]]);
  page.sendMessage = fails;
  // Nothing has looked after the connection yet.
  send("b", 2);
  assert.deepEqual(heard, [CUT]);
  send("b", 3);
  act("do");
  act("p/unfold", ["x"]);
  assert.deepEqual(heard, [CUT, NOT_DONE]);
  // What waits is shown.
  assert.deepEqual([rows.value("a"), rows.value("b")], [1, 3]);
  page.sendMessage = works;
  received = [];
  back();
  // What was sent just before may not have come through, and is sent again.
  assert.deepEqual(received, [
    ["a", 1],
    ["b", 3],
  ]);
});

test("what was sent long before is not sent again, and nothing is sent twice", (context) => {
  context.mock.method(performance, "now", () => 1e9);
  received = [];
  send("a", 5);
  context.mock.method(performance, "now", () => 1e9 + 5000);
  act("do");
  goOffline();
  back();
  goOffline();
  back();
  assert.deepEqual(received, [
    ["a", 5],
    ["do", []],
  ]);
});

test("a colour that waits is shown when the page can read it", () => {
  goOffline();
  for (const [typed, shown] of [
    ["#ff8000", [255, 128, 0]],
    ["1; 2; 3", [1, 2, 3]],
    ["red", [1, 2, 3]],
  ]) {
    send("c", typed);
    assert.deepEqual(rows.value("c"), shown);
  }
  received = [];
  back();
  assert.deepEqual(received, [["c", "red"]]);
});

test("what waits goes to the row that it is now, waits on, or is dropped", () => {
  goOffline();
  for (const id of ["a", "b", "later"]) send(id, 7);
  received = [];
  goOnline();
  /** @type {Record<string, any>} */
  const now = { a: "x", b: null };
  assert.equal(
    sendHeldBack((id) => now[id]),
    1,
  );
  assert.deepEqual(received, [["x", 7]]);
  assert.equal(sendHeldBack(), 0);
  assert.deepEqual(received, [
    ["x", 7],
    ["later", 7],
  ]);
});

test("rows of another connection than before show that it was interrupted, however short", () => {
  /** @param {string} from @param {number} base */
  const whole = (from, base) => ({
    dataset: { sambot: "rows", of: "browser" },
    textContent: JSON.stringify({
      from,
      base,
      panels: { q: [{ id: "q", in: "", kind: "readonly", value: from }] },
    }),
  });
  /** @type {any[]} */
  let elements = [];
  Object.assign(globalThis, {
    MutationObserver: class {
      observe() {}
    },
    document: { body: null, querySelectorAll: () => elements },
  });
  const shown = rows.listen(CUT, () => heard.push(rows.value("q")));
  heard.length = 0;
  for (const element of [whole("one", 0), whole("one", 1)]) {
    elements = [element];
    connect();
  }
  assert.deepEqual(heard, []);
  elements = [whole("two", 0)];
  connect();
  shown();
  // What was there before can still be noted then.
  assert.deepEqual(heard, [CUT, "one"]);
  assert.equal(rows.value("q"), "two");
  back();
});

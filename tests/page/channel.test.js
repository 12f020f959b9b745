// What happens to edits when the connection is lost.

import assert from "node:assert/strict";
import { test } from "node:test";

/** @type {any[]} */
let received = [];
const works = (/** @type {any} */ message) => received.push(message.updates.value);
const fails = () => { /* Tried to send, but the websocket is not connected! */ };
const page = { sendMessage: works };
Object.assign(globalThis, { window: { __viserMutable: page } });

const { act, CUT, goOnline, NOT_DONE, rows, send } = await import("../../src/sambot_viz/page/channel.js");

rows.take("session", "rows", { base: 0, panels: { p: [
  { id: "a", in: "", kind: "float", value: 0 }, { id: "b", in: "", kind: "float", value: 0 },
  { id: "do", in: "", kind: "action" }, { id: "p/unfold", in: "", kind: "action" },
] } });
/** @type {string[]} */
const heard = [];
for (const key of [CUT, NOT_DONE]) rows.listen(key, () => heard.push(key));

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
  page.sendMessage = works;
  received = [];
  goOnline(true);
  // What was sent just before may not have come through, and is sent again.
  assert.deepEqual(received, [["a", 1], ["b", 3]]);
});

test("what was sent long before is not sent again, and nothing is sent twice", (context) => {
  context.mock.method(performance, "now", () => 1e9);
  received = [];
  send("a", 5);
  context.mock.method(performance, "now", () => 1e9 + 5000);
  act("do");
  goOnline(false);
  goOnline(true);
  goOnline(false);
  goOnline(true);
  assert.deepEqual(received, [["a", 5], ["do", []]]);
});

// What happens to edits when the connection is lost.

import assert from "node:assert/strict";
import { mock, test } from "node:test";
import { gzipSync } from "node:zlib";

import { last, opened, received, say } from "./fake_socket.js";

const {
  act,
  connect,
  CUT,
  disconnect,
  goOffline,
  goOnline,
  NOT_DONE,
  rows,
  send,
  sendHeldBack,
  WATCHING,
  STOPS,
} = await import("../../src/sambot_viz/page/wire/channel.js");

rows.take("session", {
  all: true,
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
const clear = () => received.splice(0);
mock.timers.enable({ apis: ["setTimeout", "setInterval", "Date"] });
connect();
/** Let time pass, and the server answer. @param {number} time [ms] */
async function wait(time) {
  mock.timers.tick(time);
  await new Promise((done) => setImmediate(done));
}

test("nothing is sent before the server knows the page", async () => {
  send("a", 1);
  assert.deepEqual(received, []);
  await say({ of: "browser", all: true, panels: {} });
  send("a", 1);
  assert.deepEqual(received, [["a", 1]]);
  const { address, protocols } = /** @type {any} */ (last());
  assert.deepEqual([address, protocols], ["ws://server/?ticket=1", ["sambot-viz-1"]]);
});

test("an edit of the first moment without a connection is kept, and an action says that it is not done", async () => {
  last().onclose({});
  assert.deepEqual(heard, [CUT]);
  send("b", 2);
  send("b", 3);
  act("do");
  act("p/unfold", ["x"]);
  assert.deepEqual(heard, [CUT, NOT_DONE]);
  // What waits is shown.
  assert.deepEqual([rows.value("a"), rows.value("b")], [1, 3]);
  clear();
  await wait(100);
  await say({ of: "browser", all: true, panels: {} });
  back();
  // What was sent just before may not have come through, and is sent again.
  assert.deepEqual(received, [
    ["a", 1],
    ["b", 3],
  ]);
});

test("what was sent long before is not sent again, and nothing is sent twice", (context) => {
  context.mock.method(performance, "now", () => 1e9);
  clear();
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
  clear();
  back();
  assert.deepEqual(received, [["c", "red"]]);
});

test("what waits goes to the row that it is now, waits on, or is dropped", () => {
  goOffline();
  for (const id of ["a", "b", "later"]) send(id, 7);
  clear();
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

test("a server that does not answer is left, and tried again", async () => {
  heard.length = 0;
  const first = last();
  mock.timers.tick(10_000);
  assert.equal(first.pings, 1);
  mock.timers.tick(1000);
  await say("pong");
  for (let second = 0; second < 13; second++) mock.timers.tick(1000);
  assert.equal(first.pings, 2);
  assert.equal(last(), first);
  for (let second = 0; second < 2; second++) mock.timers.tick(1000);
  assert.deepEqual(heard, [CUT]);
  const count = opened.length - 1;
  // The close of a connection that was given up says nothing any more.
  first.onclose({});
  await wait(100);
  assert.equal(opened.length, count + 2);
  // How often it is tried is in retries.test.js.
  last().onclose({});
  await wait(1000);
  assert.equal(opened.length, count + 3);
  assert.deepEqual(heard, [CUT]);
  await say({ of: "browser", all: true, panels: {} });
  back();
});

test("a clock that is set forward or back neither ends a connection nor hides its end", async (context) => {
  heard.length = 0;
  const now = last();
  let shift = 0;
  const clock = Date.now;
  context.mock.method(Date, "now", () => clock() + shift);
  for (const hour of [1, -1]) {
    const pings = now.pings;
    for (let second = 0; second < 11 && now.pings === pings; second++) mock.timers.tick(1000);
    assert.equal(now.pings, pings + 1);
    shift += hour * 3600_000;
    await say("pong");
    for (let second = 0; second < 6; second++) mock.timers.tick(1000);
    assert.deepEqual([last(), heard], [now, []]);
  }
  // Nothing comes any more, and what came last seems to come from the future.
  shift -= 3600_000;
  for (let second = 0; second < 16; second++) mock.timers.tick(1000);
  assert.deepEqual(heard, [CUT]);
  await wait(100);
  await say({ of: "browser", all: true, panels: {} });
  back();
});

test("a long message is unpacked, and those behind it wait for it", async () => {
  const content = JSON.stringify({ of: "browser", all: true, panels: { q: [{ id: "q" }] } });
  const packed = new Uint8Array([1, ...gzipSync(content)]);
  /** @type {any[]} */
  const order = [];
  const stop = rows.listen("whole:browser", () => order.push("whole"));
  const stopRow = rows.listen("q", () => order.push(rows.value("q")));
  last().onmessage({ data: packed.buffer });
  last().onmessage({ data: JSON.stringify({ of: "browser", rows: { q: { value: 1 } } }) });
  while (order.length < 3) await new Promise((done) => setImmediate(done));
  stop();
  stopRow();
  assert.deepEqual(order, ["whole", undefined, 1]);
});

test("a server that stops says so before the connection is lost", async () => {
  /** @type {string[]} */
  const order = [];
  const ends = [STOPS, CUT].map((key) => rows.listen(key, () => order.push(key)));
  last().onclose({ code: 1012 });
  for (const end of ends) end();
  assert.deepEqual(order, [STOPS, CUT]);
  await wait(100);
});

test("a page that is left says so, and does not come again", () => {
  const socket = last();
  const count = opened.length;
  disconnect();
  assert.equal(socket.code, 4002);
  socket.onclose({});
  mock.timers.tick(60_000);
  assert.equal(opened.length, count);
});

test("the page of a follower sends nothing, and says so of what a user does", () => {
  const before = received.length,
    said = heard.length;
  rows.listen(WATCHING, () => heard.push(WATCHING));
  rows.take("follower", {
    panels: { follower: [{ id: "follower/state", kind: "data", value: { origin: "" } }] },
  });
  act("do");
  send("a", 4);
  act("p/unfold", ["x"]);
  assert.deepEqual(heard.slice(said), [WATCHING, WATCHING]);
  assert.equal(received.length, before);
  rows.take("follower", { panels: { follower: [] } });
});

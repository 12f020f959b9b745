// How often a page asks for a server that has gone.

import assert from "node:assert/strict";
import { mock, test } from "node:test";

const { PATIENCE, Retries } = await import("../../src/sambot_viz/page/wire/retries.js");

mock.timers.enable({ apis: ["setTimeout", "Date"] });
const settled = () => new Promise((done) => setImmediate(done));
/** Let time pass, as a page does that is awake. @param {number} seconds */
async function pass(seconds) {
  for (let tenth = 0; tenth < 10 * seconds; tenth++) {
    mock.timers.tick(100);
    await settled();
  }
}

/** A page whose server answers with a status. */
function page() {
  const server = { status: 0, asked: /** @type {number[]} */ ([]), opened: 0 };
  const start = Date.now();
  const retries = new Retries(async () => {
    server.asked.push((Date.now() - start) / 1000);
    return server.status;
  });
  const part = {
    ready: true,
    opening: false,
    open: () => {
      server.opened += 1;
      part.opening = true;
    },
  };
  retries.parts.push(part);
  /** @type {boolean[]} */
  const ended = [];
  retries.listeners.push((state) => ended.push(state.ended));
  const lose = () => {
    part.ready = part.opening = false;
    retries.lost();
  };
  return { server, retries, part, lose, ended };
}

test("a server that has gone is asked less and less, and after some minutes no more", async () => {
  const { server, lose, ended, retries } = page();
  lose();
  lose();
  await pass(60);
  assert.deepEqual(server.asked, [0.1, 1.1, 3.1, 8.1, 23.1, 53.1]);
  await pass(3600);
  assert.equal(server.asked.length, 14);
  assert.ok((server.asked.at(-1) || 0) * 1000 <= PATIENCE);
  assert.equal(server.opened, 0);
  assert.deepEqual([ended.filter(Boolean), ended.at(-1)], [[true], true]);
  // A page that is looked at again asks once; its user may ask for more.
  retries.now(false);
  await pass(60);
  assert.equal(server.asked.length, 15);
  retries.now();
  await pass(3600);
  assert.equal(server.asked.length, 15 + 14);
});

test("the connections are opened when the server answers, and tried until all are ready", async () => {
  const { server, part, retries, lose } = page();
  lose();
  await pass(10);
  server.status = 200;
  await pass(15);
  assert.equal(server.opened, 1);
  // One that is on its way is left alone; one that has failed is opened again.
  await pass(4);
  assert.equal(server.opened, 1);
  part.opening = false;
  retries.lost();
  await pass(6);
  assert.equal(server.opened, 2);
  Object.assign(part, { ready: true, opening: false });
  retries.back();
  const asked = server.asked.length;
  await pass(3600);
  assert.equal(server.asked.length, asked);
  // The next time begins from the first wait.
  server.status = 0;
  lose();
  await pass(2);
  assert.equal(server.asked.length, asked + 2);
});

test("a connection that seems to be there while another one is not is opened again", async () => {
  const { server, part, retries } = page();
  const other = { ready: false, opening: false, open: () => (other.opening = true) };
  retries.parts.push(other);
  server.status = 200;
  retries.lost();
  await pass(4);
  assert.deepEqual([part.ready, server.opened, other.opening], [true, 0, true]);
  await pass(20);
  assert.equal(server.opened, 1);
});

test("a clock that is set forward does not end the tries", async (context) => {
  const { server, lose, ended } = page();
  lose();
  await pass(2);
  const clock = Date.now;
  context.mock.method(Date, "now", () => clock() + 3600_000);
  await pass(10);
  assert.deepEqual([server.asked.length, ended.includes(true)], [4, false]);
});

test("a page that is left asks no more", async () => {
  const { server, retries, lose } = page();
  lose();
  retries.leave();
  retries.now();
  await pass(100);
  assert.deepEqual(server.asked, []);
});

test("a thousand pages of one server come to another one at different moments", async () => {
  let chance = 0;
  const random = mock.method(Math, "random", () => (chance = (chance + 0.618034) % 1));
  const pages = Array.from({ length: 1000 }, page);
  for (const { retries, lose, server } of pages) {
    retries.spread = 900;
    server.status = 503;
    lose();
  }
  await pass(4);
  // Those that found no place come again, spread as well.
  for (const time of [0, 1]) {
    const tenths = new Map();
    for (const { server } of pages) {
      const tenth = Math.floor(10 * server.asked[time]);
      tenths.set(tenth, (tenths.get(tenth) || 0) + 1);
    }
    assert.ok(Math.max(...tenths.values()) < 150, JSON.stringify([...tenths]));
  }
  assert.ok(pages.every(({ server }) => server.asked[0] <= 1 && server.asked[1] <= 3));
  random.mock.restore();
});

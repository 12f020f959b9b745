import assert from "node:assert/strict";
import { test } from "node:test";

import { ChangeSet, Text } from "../../src/sambot_viz/page/vendor/codemirror.js";
import { replacement, TextSync } from "../../src/sambot_viz/page/editor/text_sync.js";

/** A server that takes pieces for the newest version alone. */
class Server {
  constructor(text) {
    Object.assign(this, { text, version: 0 });
  }

  take({ version, from, to, text }) {
    if (version !== this.version) return;
    this.text = this.text.slice(0, from) + text + this.text.slice(to);
    this.version += 1;
  }
}

/** A page with a text, and what waits between it and the server. */
class Page {
  constructor(server) {
    this.server = server;
    this.sync = new TextSync(ChangeSet, server.text, 0);
    this.doc = Text.of(server.text.split("\n"));
    this.waiting = [];
  }

  type(from, to, insert) {
    const changes = ChangeSet.of({ from, to, insert }, this.doc.length);
    this.doc = changes.apply(this.doc);
    this.sync.type(changes, this.doc.toString());
  }

  send() {
    this.waiting.push(...this.sync.pieces());
  }

  arrive(count = this.waiting.length) {
    for (const piece of this.waiting.splice(0, count)) this.server.take(piece);
  }

  hear() {
    const changes = this.sync.take(this.server.version, this.server.text);
    if (!changes) return;
    this.doc = changes.apply(this.doc);
    this.sync.text = this.doc.toString();
  }
}

test("what is typed is there after an answer, also when more was typed meanwhile", () => {
  const server = new Server("<robot/>");
  const page = new Page(server);
  page.type(6, 6, ' name="r"');
  page.send();
  page.type(0, 0, "\n");
  // Nothing more is sent while something is on its way.
  page.send();
  page.arrive();
  page.hear();
  assert.equal(page.doc.toString(), '\n<robot name="r"/>');
  assert.equal(page.sync.isAhead, true);
  page.send();
  page.arrive();
  page.hear();
  assert.equal(server.text, page.doc.toString());
  assert.equal(page.sync.isAhead, false);
});

test("a large text goes in pieces that each make a version, and cut no character", () => {
  const server = new Server("ab");
  const page = new Page(server);
  page.type(1, 1, "x" + "🤖".repeat(12_000));
  page.send();
  const pieces = [...page.waiting];
  assert.equal(pieces.length, 3);
  assert.deepEqual(
    pieces.map(({ more }) => more),
    [true, true, false],
  );
  for (const { text } of pieces) assert.ok(text.length <= 10_000 && text.isWellFormed());
  for (let n = 0; n < 3; n++) {
    page.arrive(1);
    page.hear();
    assert.equal(page.doc.length, 24_003);
  }
  assert.equal(page.sync.isAhead, false);
});

test("what others write comes in between, and both texts are the same at the end", () => {
  let seed = 7;
  const random = (most) => (seed = (seed * 48271) % 0x7fffffff) % most;
  for (let round = 0; round < 200; round++) {
    const server = new Server("one\ntwo\nthree\n");
    const pages = [new Page(server), new Page(server)];
    for (let step = 0; step < 12; step++) {
      const page = pages[random(2)];
      const from = random(page.doc.length + 1);
      const to = Math.min(page.doc.length, from + random(4));
      [
        () => page.type(from, to, "xyz\n".slice(0, random(5))),
        () => page.send(),
        () => page.arrive(),
        () => page.hear(),
      ][random(4)]();
    }
    for (let end = 0; end < 6; end++)
      for (const page of pages) {
        page.arrive();
        page.hear();
        page.send();
      }
    assert.equal(pages[0].doc.toString(), server.text);
    assert.equal(pages[1].doc.toString(), server.text);
  }
});

test("after a lost connection a piece is neither lost nor written twice", () => {
  for (const came of [false, true]) {
    const server = new Server("ab");
    const page = new Page(server);
    page.type(1, 1, "x");
    page.send();
    if (came) page.arrive();
    page.waiting = [];
    page.sync.forget();
    page.hear();
    page.send();
    page.arrive();
    page.hear();
    assert.equal(server.text, "axb");
    assert.equal(page.doc.toString(), "axb");
  }
});

test("a replacement is the shortest that cuts no character", () => {
  assert.deepEqual(replacement("aaa", "aaaa"), { from: 3, to: 3, text: "a" });
  assert.deepEqual(replacement("x🤖y", "x🤔y"), { from: 1, to: 3, text: "🤔" });
  assert.deepEqual(replacement("same", "same"), { from: 4, to: 4, text: "" });
});

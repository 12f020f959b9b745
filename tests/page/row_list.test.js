// The rows of a tree that are out of sight: lines of text, which cost nothing while they change.

import assert from "node:assert/strict";
import { test } from "node:test";

import { isPlain } from "../../src/sambot_viz/page/tree/row_element.js";
import { RowList } from "../../src/sambot_viz/page/tree/row_list.js";
import { LENGTH } from "../../src/sambot_viz/page/tree/stretch.js";
import { lineText } from "../../src/sambot_viz/page/tree/row_text.js";
import { within } from "../../src/sambot_viz/page/tree/sight.js";
import { rows } from "../../src/sambot_viz/page/wire/channel.js";
import { degrees } from "../../src/sambot_viz/page/state.js";

const HEIGHT = 20;

/** As much of an element as rows out of sight need; all count the texts that they are given. */
class FakeElement {
  static texts = 0;
  static made = 0;
  constructor() {
    this.children = [];
    this.dataset = {};
    this.attributes = {};
    this.style = { setProperty() {} };
    this.classList = { add() {}, remove() {} };
    FakeElement.made += 1;
  }
  get firstElementChild() {
    return this.children[0] ?? null;
  }
  set textContent(text) {
    FakeElement.texts += 1;
    this.text = text;
  }
  append = (child) => this.children.push(child);
  after = (next) => next;
  prepend() {}
  contains = () => false;
  remove() {}
  setAttribute = (name, value) => (this.attributes[name] = value);
  getAttribute = (name) => this.attributes[name];
  removeAttribute = (name) => delete this.attributes[name];
  // All are below the window.
  getBoundingClientRect = () => ({ top: 1000, bottom: 1000 + HEIGHT });
}

globalThis.document = { createElement: () => new FakeElement(), activeElement: null };
globalThis.ResizeObserver = class {
  observe() {}
  disconnect() {}
};
globalThis.addEventListener ??= () => {};
globalThis.innerHeight = 500;

const joint = (at, value = 0) => ({
  id: `j${at}`,
  in: "",
  kind: "slider",
  name: `joint_${at}`,
  value,
  unit: "rad",
});
const FACTS = { depth: 0, opens: false, open: false, current: false, chosen: false, row: 1 };
const moved = (count, value) =>
  rows.take("session", {
    rows: Object.fromEntries(Array.from({ length: count }, (_, at) => [`j${at}`, { value }])),
  });

test("rows out of sight that move are written when they have come to rest, each once", (t) => {
  t.mock.timers.enable({ apis: ["setTimeout"] });
  const count = 300;
  const joints = Array.from({ length: count }, (_, at) => joint(at));
  rows.take("session", { all: true, panels: { joints } });
  const list = new RowList(new FakeElement());
  list.show(joints.map(({ id }) => ({ id, facts: FACTS, view: () => null })));
  // An element and a cell for so many rows.
  const stretches = count / LENGTH;
  assert.equal(FakeElement.made, 1 + 2 * stretches);
  assert.equal(FakeElement.texts, stretches);
  FakeElement.texts = 0;
  for (let step = 1; step <= 50; step++) {
    moved(count, step / 100);
    t.mock.timers.tick(100);
  }
  assert.equal(FakeElement.texts, 0);
  t.mock.timers.tick(1000);
  assert.equal(FakeElement.texts, stretches);
  const lines = list.stretches[0].element.children[0].text.split("\n");
  assert.equal(lines[7], "joint_7\u20030.5 rad");
  t.mock.timers.tick(10000);
  assert.equal(FakeElement.texts, stretches);
  list.clear();
  moved(count, 0);
  t.mock.timers.tick(10000);
  assert.equal(FakeElement.texts, stretches);
});

test("what is in sight is what reaches into the window, whatever the heights", () => {
  for (let count = 0; count < 12; count++)
    for (let seed = 1; seed < 8; seed++) {
      let at = -40;
      const list = Array.from({ length: count }, (_, i) => {
        const height = ((i * seed) % 5) * 7 + 3;
        return { top: at, bottom: (at += height) };
      });
      for (const [top, bottom] of [
        [0, 30],
        [-100, -50],
        [0, 1],
        [-100, 500],
        [200, 210],
      ]) {
        const [from, end] = within(list, top, bottom, (one) => one);
        const wanted = list.filter((one) => one.bottom > top && one.top < bottom);
        assert.deepEqual(list.slice(from, end), wanted);
      }
    }
});

test("the line of a row has its name and its value as its cell shows it", () => {
  const line = (kind, value, more = {}) =>
    lineText({ id: "a", in: "", kind, name: "N", value, ...more });
  assert.equal(line("slider", 1.23456789, { unit: "rad" }), "N\u20031.2346 rad");
  assert.equal(line("float", 0.1, { unit: "m", name: "Size (m)" }), "Size (m)\u20030.1");
  assert.equal(line("vector", [1, 2.5, 0], { unit: "m" }), "N\u20031; 2.5; 0 m");
  assert.equal(line("color", [1, 2, 3]), "N\u20031; 2; 3");
  assert.equal(line("status", "Ok", { whole: true }), "N: Ok");
  assert.equal(line("enum", "Orbit"), "N\u2003Orbit");
  assert.equal(line("readonly", "two\n lines"), "N\u2003two lines");
  for (const kind of ["bool", "display", "group"]) assert.equal(line(kind, true), "N");
  degrees.set(true);
  assert.equal(line("slider", Math.PI / 2, { unit: "rad" }), "N\u200390 °");
  degrees.set(false);
});

test("texts that may need several lines are always drawn, as nothing else knows their height", () => {
  const plain = (kind, more = {}) => isPlain({ id: "a", in: "", kind, value: "", ...more });
  for (const kind of ["slider", "bool", "float", "enum", "color", "group"]) assert.ok(plain(kind));
  for (const kind of ["note", "lines"]) assert.ok(!plain(kind));
  assert.ok(plain("status", { value: "Ok" }));
  assert.ok(!plain("status", { value: "a sentence that is longer than a line" }));
  assert.ok(!plain("readonly", { value: "x", copy: true }));
});

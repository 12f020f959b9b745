// What a search shows of a tree: what is found, and the rows that it is in.

import assert from "node:assert/strict";
import { test } from "node:test";

import { fold } from "../../src/sambot_viz/page/state.js";
import {
  firstFound,
  isFound,
  matches,
  searchKey,
  wordsOf,
} from "../../src/sambot_viz/page/tree/search.js";
import { lists } from "../../src/sambot_viz/page/tree/row_list.js";
import { visible } from "../../src/sambot_viz/page/tree/tree.js";
import { rows } from "../../src/sambot_viz/page/wire/channel.js";

const row = (id, name, above = "", more = {}) => ({ id, in: above, kind: "float", name, ...more });
const take = () =>
  rows.take("session", {
    all: true,
    panels: {
      displays: [
        row("g", "Grid", "", { open: true }),
        row("g/a", "Alpha", "g"),
        row("g/o", "Offset", "g"),
        row("r", "RobotModel"),
        row("r/a", "Alpha", "r"),
        row("r/l", "Links", "r"),
        row("r/l/w", "wheel", "r/l"),
        row("r/l/w/a", "Alpha", "r/l/w"),
      ],
    },
  });
const found = (text) => {
  const words = wordsOf(text);
  return visible("displays", words.length ? (one) => isFound(one, words) : undefined).map(
    ({ id, open }) => (open ? `${id} open` : id),
  );
};

test("without a search what is unfolded is shown", () => {
  take();
  assert.deepEqual(found(""), ["g open", "g/a", "g/o", "r"]);
});

test("what is found keeps the rows above it, also in folded ones, and no others", () => {
  take();
  assert.deepEqual(found("ALPHA"), [
    "g open",
    "g/a",
    "r open",
    "r/a",
    "r/l open",
    "r/l/w open",
    "r/l/w/a",
  ]);
  assert.deepEqual(found("nothing"), []);
});

test("words may be in the names above, one is in the row's own", () => {
  take();
  assert.deepEqual(found("wheel alpha"), ["r open", "r/l open", "r/l/w open", "r/l/w/a"]);
  assert.deepEqual(found("grid off"), ["g open", "g/o"]);
});

test("what is unfolded below a row that is found is shown with it, and can be folded", () => {
  take();
  assert.deepEqual(found("grid"), ["g open", "g/a", "g/o"]);
  fold("g", false);
  assert.deepEqual(found("grid"), ["g"]);
  fold("g", true);
  assert.deepEqual(found("robot"), ["r"]);
});

test("the best match is the name itself, then its beginning, then a word in it", () => {
  const all = ["my_grid", "grid_map", "agrid", "Grid", "Alpha"].map((name) => ({
    name,
    where: name === "Alpha" ? "Displays › Grid" : "Displays",
    kind: "display",
  }));
  const names = (text) => matches(all, text).map(({ name }) => name);
  assert.deepEqual(names("grid"), ["Grid", "grid_map", "my_grid", "agrid", "Alpha"]);
  assert.deepEqual(names("grid alp"), ["Alpha"]);
  assert.deepEqual(names(" "), ["my_grid", "grid_map", "agrid", "Grid", "Alpha"]);
  assert.deepEqual(names("x"), []);
});

test("letters in their order find a long name, after all that has the words", () => {
  const all = ["drivewhl_l_joint", "drivl", "arm_drivl"].map((name) => ({
    name,
    where: "Joints",
    kind: "joints",
  }));
  const names = (text) => matches(all, text).map(({ name }) => name);
  assert.deepEqual(names("drivl"), ["drivl", "arm_drivl", "drivewhl_l_joint"]);
  assert.deepEqual(names("lvird"), []);
  assert.deepEqual(names("rivl"), ["drivl", "arm_drivl"]);
});

test("what is said of a thing finds it, after all that has the words in its name", () => {
  const all = [
    { name: "drivewhl_l_joint", where: "Joints", kind: "joints", words: "wheel continuous joint" },
    { name: "Wheels", where: "Drive", kind: "drive", words: "" },
    { name: "Degrees", where: "Joints", kind: "command", words: "Angles are in radians" },
  ];
  const names = (text) => matches(all, text).map(({ name }) => name);
  assert.deepEqual(names("wheel"), ["Wheels", "drivewhl_l_joint"]);
  assert.deepEqual(names("joints radian"), ["Degrees"]);
  assert.deepEqual(names("adian"), []);
});

test("what is found first may be limited, and is nothing without a text or a hit", () => {
  take();
  assert.equal(firstFound("displays", "alpha"), "g/a");
  assert.equal(
    firstFound("displays", "w", (one) => one.in === "r/l"),
    "r/l/w",
  );
  assert.equal(firstFound("displays", "  "), undefined);
  assert.equal(firstFound("displays", "xyzzy"), undefined);
  assert.equal(firstFound("nowhere", "alpha"), undefined);
});

test("Enter in a search goes to what is found, and nowhere without a hit or a text", () => {
  take();
  const asked = [];
  const tree = {};
  lists.set(tree, { touch: (id) => void asked.push(id) });
  globalThis.document = { querySelector: () => tree };
  const press = (key, value, first) => {
    const cleared = [];
    const event = { key, target: { value }, preventDefault() {}, stopPropagation() {} };
    searchKey(event, "displays", { clear: () => cleared.push(key), first });
    return [...asked.splice(0), ...cleared];
  };
  try {
    assert.deepEqual(press("Enter", "wheel"), ["r/l/w"]);
    assert.deepEqual(press("Enter", "xyzzy"), []);
    assert.deepEqual(press("Enter", ""), []);
    assert.deepEqual(press("ArrowDown", "xyzzy"), []);
    assert.deepEqual(press("ArrowDown", ""), ["g"]);
    assert.deepEqual(press("Escape", "x"), ["Escape"]);
    // Where the server searches, the names of rows do not say what is found.
    assert.deepEqual(
      press("Enter", "camera/image", (text) => text && "leaf"),
      ["leaf"],
    );
    assert.deepEqual(
      press("Enter", "wheel", () => undefined),
      [],
    );
  } finally {
    delete globalThis.document;
  }
});

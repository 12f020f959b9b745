import assert from "node:assert/strict";
import { test } from "node:test";
import { Rows } from "../../src/sambot_viz/page/wire/rows.js";

/** @param {string} id @param {any} [more] */
const row = (id, more = {}) => ({ id, in: "", kind: "float", ...more });

/** Rows of one panel, and what its listeners have heard. */
function grid() {
  const rows = new Rows();
  rows.take("session", {
    all: true,
    panels: {
      displays: [row("a", { value: 1 }), row("a/x", { in: "a", value: 2 }), row("b", { value: 3 })],
    },
  });
  /** @type {string[]} */
  const heard = [];
  for (const key of ["a", "a/x", "b", "panel:displays"]) rows.listen(key, () => heard.push(key));
  return { rows, heard };
}

test("rows are in order below the row that holds them", () => {
  const { rows } = grid();
  assert.deepEqual(rows.children("panel:displays"), ["a", "b"]);
  assert.deepEqual(rows.children("a"), ["a/x"]);
  assert.deepEqual(rows.children("b"), []);
});

test("a change of one row is heard by that row alone", () => {
  const { rows, heard } = grid();
  rows.take("session", { rows: { "a/x": { value: 5 } } });
  assert.equal(rows.value("a/x"), 5);
  assert.deepEqual(heard, ["a/x"]);
});

test("a row that can be unfolded from now on is heard by its panel, which draws the arrow", () => {
  for (const part of [
    { rows: { b: { lazy: true } } },
    {
      panels: {
        displays: [
          row("a", { value: 1 }),
          row("a/x", { in: "a", value: 2 }),
          row("b", { value: 3, lazy: true }),
        ],
      },
    },
  ]) {
    const { rows, heard } = grid();
    rows.take("session", part);
    assert.deepEqual(heard, ["b", "panel:displays"]);
  }
});

test("a change that says what is known already is not heard", () => {
  const { rows, heard } = grid();
  rows.take("session", { rows: { a: { value: 1 } } });
  assert.deepEqual(heard, []);
});

test("null takes a field away", () => {
  const { rows } = grid();
  rows.take("session", { rows: { a: { level: "warn" } } });
  rows.take("session", { rows: { a: { level: null } } });
  assert.equal("level" in (rows.get("a") || {}), false);
});

test("changes of other rows than these are left alone", () => {
  const { rows } = grid();
  rows.take("session", { rows: { gone: { value: 9 } } });
  assert.equal(rows.get("gone"), undefined);
});

test("a row that moves is heard by its panel, and by no row that stays as it is", () => {
  const { rows, heard } = grid();
  const [a, x, b] = ["a", "a/x", "b"].map((id) => /** @type {any} */ (rows.get(id)));
  rows.take("session", { panels: { displays: [b, a, x] } });
  assert.deepEqual(rows.children("panel:displays"), ["b", "a"]);
  assert.deepEqual(heard, ["panel:displays"]);
});

test("a row that goes is heard, and is not there any more", () => {
  const { rows, heard } = grid();
  rows.take("session", {
    panels: { displays: [/** @type {any} */ (rows.get("b"))] },
  });
  assert.equal(rows.get("a/x"), undefined);
  assert.deepEqual(rows.children("a"), []);
  assert.deepEqual(heard.sort(), ["a", "a/x", "panel:displays"]);
});

test("the rows of a session and those of a browser do not touch each other", () => {
  const { rows } = grid();
  rows.take("browser", { all: true, panels: { tools: [row("tool", { value: 1 })] } });
  rows.take("browser", { rows: { tool: { value: 2 } } });
  rows.take("session", { rows: { a: { value: 4 } } });
  assert.deepEqual([rows.value("tool"), rows.value("a")], [2, 4]);
});

test("the numbers of a vector are rows of their own", () => {
  const rows = new Rows();
  const vector = {
    id: "v",
    in: "",
    kind: "vector",
    name: "Offset",
    unit: "m",
    parts: ["X", "Y"],
    value: [1, 2],
  };
  rows.take("session", { all: true, panels: { displays: [vector] } });
  assert.deepEqual(rows.children("v"), ["v/.X", "v/.Y"]);
  assert.deepEqual(rows.get("v/.Y"), {
    id: "v/.Y",
    in: "v",
    kind: "float",
    name: "Y",
    value: 2,
    part: 1,
    unit: "m",
  });
  /** @type {string[]} */
  const heard = [];
  for (const key of ["v", "v/.X", "v/.Y"]) rows.listen(key, () => heard.push(key));
  rows.take("session", { rows: { v: { value: [1, 5] } } });
  assert.equal(rows.value("v/.Y"), 5);
  assert.deepEqual(heard, ["v", "v/.Y"]);
  rows.take("session", { panels: { displays: [] } });
  assert.equal(rows.get("v/.X"), undefined);
});

test("who stops listening twice does not stop those who came after", () => {
  const rows = new Rows();
  /** @type {string[]} */
  const heard = [];
  const stop = rows.listen("a", () => heard.push("first"));
  stop();
  const later = rows.listen("a", () => heard.push("later"));
  stop();
  rows.notify("a");
  assert.deepEqual(heard, ["later"]);
  later();
  rows.notify("a");
  assert.deepEqual(heard, ["later"]);
});

test("a value that is hoped for is shown, and put back when it is refused", () => {
  const { rows } = grid();
  rows.hope("a", 7);
  rows.hope("a", 8);
  assert.equal(rows.value("a"), 8);
  rows.putBack("a");
  assert.equal(rows.value("a"), 1);
});

test("what the server says counts more than what is hoped for", () => {
  const { rows } = grid();
  rows.hope("a", 7);
  rows.take("session", { rows: { a: { value: 7 } } });
  rows.putBack("a");
  assert.equal(rows.value("a"), 7);
});

test("a server that was started again with fewer panels leaves no old rows", () => {
  const { rows } = grid();
  /** @type {string[]} */
  const heard = [];
  rows.listen("whole:session", () => heard.push("whole"));
  rows.take("session", { all: true, panels: { names: [] } });
  assert.deepEqual(rows.children("panel:displays"), []);
  assert.equal(rows.get("a"), undefined);
  assert.deepEqual(heard, ["whole"]);
});

test("who watches cannot set what others see, and their own rows they can", () => {
  const { rows } = grid();
  rows.take("browser", {
    all: true,
    panels: {
      views: [
        { id: "mine", in: "", kind: "float", value: 1, local: true },
        { id: "fact", in: "", kind: "readonly", fixed: true, value: "x" },
      ],
    },
  });
  let heard = 0;
  rows.listen("a", () => {
    heard += 1;
  });
  assert.equal(rows.get("a")?.off, undefined);
  rows.watch(true);
  assert.equal(heard, 1);
  assert.deepEqual(
    [rows.get("a")?.off, rows.get("mine")?.off, rows.get("fact")?.off],
    [true, undefined, undefined],
  );
  assert.equal(rows.get("a"), rows.get("a"));
  rows.watch(true, true);
  assert.deepEqual([rows.get("a")?.off, rows.get("mine")?.off], [true, true]);
  rows.watch(false);
  assert.deepEqual([heard, rows.get("a")?.off], [3, undefined]);
});

test("data and commands are beside the rows, and follow the server too", () => {
  const { rows } = grid();
  /** @type {string[]} */
  const heard = [];
  for (const key of ["x/names", "x/do", "x/mine", "panel:x"])
    rows.listen(key, () => heard.push(key));
  const part = (/** @type {any[]} */ ...items) =>
    rows.take("browser", { all: true, panels: { x: items } });
  const names = { id: "x/names", in: "", kind: "data", value: ["a"] };
  const doIt = { id: "x/do", in: "", kind: "command" };
  const mine = { id: "x/mine", in: "", kind: "command", local: true };
  part(names, doIt, mine);
  assert.deepEqual(heard, ["x/names", "x/do", "x/mine", "panel:x"]);
  assert.deepEqual(rows.children("panel:x"), []);
  assert.deepEqual([rows.data("x/names"), rows.get("x/names")], [["a"], undefined]);
  assert.deepEqual([rows.can("x/do"), rows.can("x/mine"), rows.can("x/no")], [true, true, false]);
  rows.take("browser", { rows: { "x/names": { value: ["a", "b"] } } });
  assert.deepEqual(rows.data("x/names"), ["a", "b"]);
  rows.watch(true);
  assert.deepEqual([rows.can("x/do"), rows.can("x/mine")], [false, true]);
  rows.watch(true, true);
  assert.deepEqual([rows.can("x/do"), rows.can("x/mine")], [false, false]);
  rows.watch(false);
  heard.length = 0;
  part(names, mine);
  assert.deepEqual(heard, ["x/do", "x/names"]);
  assert.deepEqual([rows.knows("x/do"), rows.data("x/names")], [false, ["a"]]);
});

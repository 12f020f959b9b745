import assert from "node:assert/strict";
import { test } from "node:test";

// What the page's scripts want of a browser when they are read.
Object.assign(globalThis, {
  localStorage: { getItem: () => null, setItem: () => {} },
  addEventListener: () => {},
});
const { Blocks } = await import("../../src/sambot_viz/page/panels/lesson_text.js");
const { counted, earned, verdict } = await import("../../src/sambot_viz/page/panels/lesson.js");

/** The elements and texts of what a component draws. */
function drawn(node) {
  if (Array.isArray(node)) return node.flatMap(drawn);
  if (node === null || typeof node !== "object") return [String(node)];
  assert.equal("dangerouslySetInnerHTML" in node.props, false);
  const { children, ...props } = node.props;
  return [[node.type, props], ...(children === undefined ? [] : drawn(children))];
}
/** @param {object} block */
const seen = (block) =>
  drawn(Blocks({ blocks: [{ kind: "paragraph", lines: [], text: "", word: "", ...block }] }));

test("a text has elements for its spans, and its HTML is text", () => {
  const lines = [
    [
      ["<b>x</b>", "", ""],
      ["<link>", "code", ""],
      ["bold", "strong", ""],
    ],
  ];
  assert.deepEqual(seen({ lines }), [
    ["p", {}],
    "<b>x</b>",
    ["code", {}],
    "<link>",
    ["strong", {}],
    "bold",
  ]);
  assert.deepEqual(seen({ kind: "code", text: "<a/>\n" }), [["pre", {}], ["code", {}], "<a/>\n"]);
});

test("a link leads to the web, or nowhere", () => {
  const link = (/** @type {string} */ href) => seen({ lines: [[["here", "link", href]]] });
  assert.equal(link("https://docs.nav2.org")[1][1].href, "https://docs.nav2.org");
  assert.deepEqual(link("javascript:alert(1)"), [["p", {}], "here"]);
});

test("a picture that cannot be read is told in words", () => {
  assert.deepEqual(seen({ kind: "picture", text: "a box", word: "box.png", data: "" })[1], "[");
  const [[type, props]] = seen({ kind: "picture", text: "a box", data: "data:image/png;base64," });
  assert.deepEqual([type, props.alt], ["img", "a box"]);
});

test("points are those of the steps that have passed", () => {
  const steps = [
    { title: "a", points: 2, passed: true },
    { title: "b", points: 3, passed: false },
  ];
  assert.equal(earned(steps), "2 of 5 points");
});

test("what is said below the conditions follows the tries", () => {
  const state = { outcomes: [], tries: 0, passed: false, checking: false, trouble: "", hint_in: 1 };
  const fault = { holds: false, text: "no link", place: "" };
  assert.equal(verdict({ ...state, outcomes: null }), "Checking…");
  assert.equal(verdict({ ...state, outcomes: [fault] }), "A hint comes after 1 try more.");
  assert.equal(verdict({ ...state, outcomes: [fault], tries: 1, hint_in: 0 }), "1 try so far. ");
  assert.equal(verdict({ ...state, passed: true }), "All holds.");
});

test("steps that hold while another one is read are told", () => {
  assert.equal(counted([]), "");
  assert.match(counted([4]), /^Step 4 holds too/);
  assert.match(counted([2, 4, 7]), /^Steps 2, 4 and 7 hold too/);
});

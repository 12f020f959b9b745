// @ts-check
/* The board of a class: the order of its rows, and what they say. */

import assert from "node:assert/strict";
import { test } from "node:test";

import { ago, presence, problems, sorted, summary } from "../../src/sambot_viz/page/board/rows.js";

/** @param {Partial<import("../../src/sambot_viz/page/board/rows.js").BoardRow>} fields @returns {any} */
const row = (fields) => ({ errors: 0, warnings: 0, pages: 1, step: 1, stuck: false, ...fields });

test("who is stuck for longest comes first, who is done last", () => {
  const rows = [
    row({ name: "done", order: /** @type {any} */ ([true, true, 1, 1]) }),
    row({ name: "works", order: /** @type {any} */ ([false, true, 5, 2]) }),
    row({ name: "stuck", order: /** @type {any} */ ([false, false, 9, 3]) }),
    row({ name: "long stuck", order: /** @type {any} */ ([false, false, 2, 4]) }),
  ];
  assert.deepEqual(
    sorted(rows).map(({ name }) => name),
    ["long stuck", "stuck", "works", "done"],
  );
});

test("problems and times are said in few words", () => {
  assert.equal(problems(row({ errors: 1, warnings: 2 })), "1 error, 2 warnings");
  assert.equal(problems(row({})), "none");
  const said = [0, 5, 990, 70, -5000, -100000].map((at) => ago(at && at + 100000, 100990));
  assert.deepEqual(said, ["–", "16 min", "now", "15 min", "1 h", "–"]);
});

test("the class is said in a line", () => {
  const rows = [row({ stuck: true }), row({ step: 3, stuck: true, pages: 0 })];
  assert.equal(summary(rows, 2), "2 students, 1 here, 1 stuck, 1 done");
});

test("a row says where its student is", () => {
  assert.equal(presence(row({ pages: 2, server: "" })), 2);
  assert.equal(presence(row({ pages: 0, server: "" })), "away");
  assert.equal(presence(row({ pages: 1, server: "does not answer" })), "does not answer");
  const rows = [row({ pages: 1, server: "does not answer" }), row({ pages: 1, server: "" })];
  assert.match(summary(rows, 3), /^2 students, 1 here/);
});

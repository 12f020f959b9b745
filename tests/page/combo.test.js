import assert from "node:assert/strict";
import { test } from "node:test";
import { offers, preselected, taken as accepted } from "../../src/sambot_viz/page/cells/combo.js";

const FRAMES = ["<Fixed Frame>", "base_link", "left_wheel", "right_wheel", "link"];
/** What Enter takes after a text was typed. @param {string} typed */
const taken = (typed) => {
  const all = offers(FRAMES, typed);
  return all[preselected(all, typed)]?.name;
};

test("all names are offered before something is typed", () => {
  assert.deepEqual(
    offers(FRAMES, null).map(({ name }) => name),
    FRAMES,
  );
  assert.equal(preselected(offers(FRAMES, null), null), -1);
});

test("part of a name finds it, whatever its case", () => {
  assert.equal(taken("left"), "left_wheel");
  assert.equal(taken("BASE"), "base_link");
});

test("a name that is typed in full is meant, also when others contain it", () => {
  assert.equal(taken("link"), "link");
  assert.deepEqual(
    offers(FRAMES, "link").map(({ name }) => name),
    ["link", "base_link"],
  );
});

test("a text that several names contain is kept as it is, unless one is chosen", () => {
  assert.equal(taken("wheel"), "wheel");
  assert.deepEqual(
    offers(FRAMES, "wheel").map(({ name, isNew }) => [name, isNew]),
    [
      ["left_wheel", false],
      ["right_wheel", false],
      ["wheel", true],
    ],
  );
});

test("a name that there is not can be kept", () => {
  assert.equal(taken(" map "), "map");
  assert.deepEqual(offers(FRAMES, "map"), [{ name: "map", isNew: true }]);
});

test("each name is offered once", () => {
  assert.deepEqual(
    offers(["a", "a", "b"], null).map(({ name }) => name),
    ["a", "b"],
  );
});

test("an emptied field is what it was, unless nothing is a value too", () => {
  const all = offers(FRAMES, "");
  assert.equal(accepted(all, preselected(all, ""), "", "link", false), "link");
  assert.equal(accepted(all, preselected(all, ""), "", "link", true), "");
  assert.equal(accepted(all, 1, "", "link", true), "base_link");
  assert.equal(accepted(all, preselected(all, null), null, "link", true), "link");
});

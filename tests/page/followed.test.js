// Who tries to move a joint that messages move is told what does.

import assert from "node:assert/strict";
import { test } from "node:test";

import { followedText } from "../../src/sambot_viz/page/cells/followed.js";

test("it is said what moves a joint while its messages are followed, and only then", () => {
  const row = { id: "joints/follow", in: "", kind: "bool", name: "Follow square.mcap" };
  const said = "This joint is moved by square.mcap. Untick Follow to move it here.";
  assert.equal(followedText({ ...row, value: true }), said);
  assert.equal(followedText({ ...row, value: false }), "");
  assert.equal(followedText(undefined), "");
});

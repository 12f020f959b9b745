import assert from "node:assert/strict";
import { test } from "node:test";

import { jointAround } from "../../src/sambot_viz/page/editor/joint_around.js";

const TEXT = `<robot>
<joint name="a" type="fixed"><parent link="b"/></joint>
<joint type="fixed" name='c'/>
<joint name="\${prefix}_d"><axis/></joint>
</robot>`;

test("the joint is that in whose element the cursor is, where its name is written", () => {
  const at = (/** @type {string} */ words) => jointAround(TEXT, TEXT.indexOf(words));
  assert.equal(at("type"), "a");
  assert.equal(at("link"), "a");
  assert.equal(at("name='c'"), "c");
  assert.equal(at("<axis"), "");
  assert.equal(at('\n<joint name="\\${'), "");
  assert.equal(at("</robot>"), "");
  assert.equal(jointAround("", 0), "");
});

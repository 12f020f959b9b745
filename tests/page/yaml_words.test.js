// @ts-check
import assert from "node:assert/strict";
import { test } from "node:test";
import { offeredIn } from "../../src/sambot_viz/page/editor/yaml_words.js";

const KEYS = {
  "": { amcl: [], ekf_filter_node: [] },
  amcl: { base_frame_id: ["base_link"], alpha1: [] },
  ekf_filter_node: { two_d_mode: ["true", "false"] },
};
const AMCL = "amcl:\n  ros__parameters:\n";

test("keys are those of the node that is above", () => {
  const found = offeredIn(`${AMCL}    ba`, KEYS);
  assert.deepEqual(found, {
    from: AMCL.length + 4,
    labels: ["base_frame_id", "alpha1"],
    ends: ": ",
  });
  const later = `${AMCL}    alpha1: 0.2\n/robot/ekf_filter_node:\n  ros__parameters:\n    `;
  assert.deepEqual(offeredIn(later, KEYS)?.labels, ["two_d_mode"]);
  assert.deepEqual(offeredIn(`${AMCL}am`, KEYS)?.labels, ["amcl", "ekf_filter_node"]);
});

test("values are those of the key before them", () => {
  const found = offeredIn(`${AMCL}    base_frame_id: "ba`, KEYS);
  assert.deepEqual(found?.labels, ["base_link"]);
  assert.equal(found?.ends, "");
  assert.equal(offeredIn(`${AMCL}    alpha1: `, KEYS), null);
  assert.equal(offeredIn(`${AMCL}    # ba`, KEYS), null);
});

test("a list of maps has one set of keys", () => {
  const keys = { "-": { direction: ["GZ_TO_ROS"], ros_topic_name: [] } };
  assert.deepEqual(offeredIn("- ros", keys)?.labels, ["direction", "ros_topic_name"]);
  assert.deepEqual(offeredIn("- ros_topic_name: a\n  direction: G", keys)?.labels, ["GZ_TO_ROS"]);
});

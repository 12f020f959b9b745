// Arguments of static_transform_publisher with sums and units.

import assert from "node:assert/strict";
import { test } from "node:test";

import { workedOut } from "../../src/sambot_viz/page/cells/pasted.js";

test("sums and units among eight values are worked out, in metres and radians", () => {
  assert.equal(
    workedOut("0 1 5cm pi/2 90deg 0 a b"),
    "0 1 0.05 1.570796326795 1.570796326795 0 a b",
  );
  assert.equal(
    workedOut(
      "ros2 run tf2_ros static_transform_publisher 1/4 0 0 0 0 -pi pi m --ros-args -r a:=b",
    ),
    "ros2 run tf2_ros static_transform_publisher 0.25 0 0 0 0 -3.14159265359 pi m --ros-args -r a:=b",
  );
});

test("the values of flags are worked out, names of frames are not", () => {
  assert.equal(
    workedOut("--x 15mm --yaw 180deg --frame-id 2m --child-frame-id pi"),
    "--x 0.015 --yaw 3.14159265359 --frame-id 2m --child-frame-id pi",
  );
});

test("plain numbers, quaternions, lists and what is wrong stay as they were pasted", () => {
  for (const pasted of [
    "0.1 -2 1e-3 0 0 0 a b",
    "0 0 0 0 0 0 1 a b",
    "arguments=['0', '0', '0', 'a', 'b']",
    "0 0 0 5cm 0 0 a b",
    "0 0 zwei 0 0 0 a b",
  ])
    assert.equal(workedOut(pasted), pasted);
});

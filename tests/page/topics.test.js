// Which topic is selected.

import assert from "node:assert/strict";
import { test } from "node:test";

import { topicOf } from "../../src/sambot_viz/page/panels/topics.js";
import { rows } from "../../src/sambot_viz/page/wire/channel.js";

test("a row is of its own topic, drawn or not, or of the one that it is below", () => {
  const scan = { id: "topic:/scan", in: "", kind: "readonly", name: "/scan", display: "LaserScan" };
  const camera = { id: "topic:/camera", in: "", kind: "readonly", name: "/camera" };
  const type = { id: "topic:/camera/type", in: "topic:/camera", kind: "readonly", name: "Type" };
  rows.take("session", { all: true, panels: { topics: [scan, camera, type] } });
  const name = (id) => topicOf(rows.get(id))?.name;
  assert.equal(name("topic:/scan"), "/scan");
  assert.equal(name("topic:/camera"), "/camera");
  assert.equal(name("topic:/camera/type"), "/camera");
  assert.equal(name("none"), undefined);
});

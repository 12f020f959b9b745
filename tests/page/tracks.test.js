import assert from "node:assert/strict";
import { test } from "node:test";
import { gzipSync } from "node:zlib";
import { at, read, unpack } from "../../src/sambot_viz/page/player/tracks.js";

const turning = {
  type: "SetOrientationMessage",
  prop: "wxyz",
  name: "/w",
  first: [1, 0, 0, 0],
  since: [0, 100, 100],
  values: [
    [1, 0, 0, 0],
    [0, 1, 0, 0],
    [0, 0, 1, 0],
  ],
};
const message = (/** @type {number[]} */ wxyz) => [
  { type: "SetOrientationMessage", name: "/w", owner: "", wxyz },
];

test("a node is sent only what changes, forwards and back", () => {
  const tracks = unpack([turning]);
  assert.deepEqual(at(tracks, 0), message([1, 0, 0, 0]));
  assert.deepEqual(at(tracks, 50), []);
  assert.deepEqual(at(tracks, 150), message([0, 1, 0, 0]));
  assert.deepEqual(at(tracks, 1e6), message([0, 0, 1, 0]));
  assert.deepEqual(at(tracks, 100), message([0, 1, 0, 0]));
});

test("before its first value, a node has what it had in the first picture", () => {
  const tracks = unpack([{ ...turning, since: [500, 100, 100], first: [0, 0, 0, 1] }]);
  assert.deepEqual(at(tracks, 0), []);
  at(tracks, 600);
  assert.deepEqual(at(tracks, 10), message([0, 0, 0, 1]));
});

test("a node that comes later goes again, and comes back with what was set of it", () => {
  const node = {
    type: "",
    prop: "",
    name: "/w",
    first: null,
    since: [100],
    values: [{ type: "FrameMessage", name: "/w", props: {} }],
  };
  const tracks = unpack([{ ...turning, first: null, since: [200], values: [[0, 1, 0, 0]] }, node]);
  assert.deepEqual(
    at(tracks, 300).map(({ type }) => type),
    ["FrameMessage", "SetOrientationMessage"],
  );
  assert.deepEqual(
    at(tracks, 0).map(({ type }) => type),
    ["RemoveSceneNodeMessage"],
  );
  assert.deepEqual(at(tracks, 50), []);
  assert.deepEqual(
    at(tracks, 300).map(({ type }) => type),
    ["FrameMessage", "SetOrientationMessage"],
  );
});

test("arrays are arrays again", async () => {
  const points = {
    dtype: "<f4",
    base64: Buffer.from(new Float32Array([1.5, -2]).buffer).toString("base64"),
  };
  const line = {
    type: "SceneNodeUpdateMessage",
    prop: "points",
    name: "/l",
    first: null,
    since: [0],
    values: [points],
  };
  const tracks = await read(gzipSync(JSON.stringify([line])).toString("base64"));
  assert.deepEqual(at(tracks, 0), [
    {
      type: "SceneNodeUpdateMessage",
      name: "/l",
      owner: "",
      updates: { points: new Float32Array([1.5, -2]) },
    },
  ]);
});

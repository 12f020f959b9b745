// What viser gets of poses that move, from what the server says of them.

import assert from "node:assert/strict";
import { test } from "node:test";

Object.assign(globalThis, { window: globalThis });
await import("../../src/sambot_viz/page/viser_poses.js");
const poses = /** @type {NonNullable<typeof window.sambotPoses>} */ (globalThis.sambotPoses);

const turn = (/** @type {string} */ name, /** @type {number} */ number, owner = "") => ({
  type: "SetOrientationMessage",
  name,
  owner,
  wxyz: [1, 0, 0, 0],
  number,
});
const shift = (/** @type {string} */ name, /** @type {number} */ number, owner = "") => ({
  type: "SetPositionMessage",
  name,
  owner,
  position: [0, 0, 0],
  number,
});
/** A frame, at an odd place of a longer buffer. @param {[number, number[]][]} tracks */
function frame(tracks) {
  const values = tracks.flatMap(([, value]) => value);
  const numbers = tracks.flatMap(([number]) => {
    const low = number % 128,
      high = Math.floor(number / 128);
    return high ? [128 + low, high] : [low];
  });
  const bytes = new Uint8Array(3 + numbers.length + 1 + 8 * values.length);
  bytes.set(numbers, 3);
  const view = new DataView(bytes.buffer, 3 + numbers.length + 1);
  values.forEach((value, i) => view.setFloat64(8 * i, value, true));
  return { type: "SetPositionMessage", name: "~", owner: "", position: bytes.subarray(3) };
}

test("what has moved is told with the names that its numbers were told with", () => {
  const first = [turn("/a", 2), shift("/b", 777, "7"), { type: "FrameMessage", name: "/c" }];
  assert.deepEqual(poses.unpacked(first), first);
  assert.deepEqual(
    poses.unpacked([
      frame([
        [777, [1 / 3, 4e6, -2]],
        [2, [0.6, 0.8, 0, 0]],
      ]),
    ]),
    [
      { type: "SetPositionMessage", name: "/b", owner: "7", position: [1 / 3, 4e6, -2] },
      { type: "SetOrientationMessage", name: "/a", owner: "", wxyz: [0.6, 0.8, 0, 0] },
    ],
  );
});

test("it comes where it was said, among the other messages", () => {
  const made = { type: "FrameMessage", name: "/d", owner: "", props: {} };
  const gone = { type: "RemoveSceneNodeMessage", name: "/e" };
  const told = shift("/d", 9);
  const all = poses.unpacked([made, told, frame([[9, [1, 2, 3]]]), gone]);
  assert.deepEqual(all, [
    made,
    told,
    { type: "SetPositionMessage", name: "/d", owner: "", position: [1, 2, 3] },
    gone,
  ]);
});

test("a number that is not known is passed over", () => {
  poses.unpacked([turn("/a", 2), turn("/a", 12)]);
  const both = frame([
    [2, [1, 0, 0, 0]],
    [99, [1, 0, 0]],
    [12, [0, 1, 0, 0]],
  ]);
  assert.deepEqual(poses.unpacked([both]), [
    { type: "SetOrientationMessage", name: "/a", owner: "", wxyz: [0, 1, 0, 0] },
  ]);
  poses.clear();
  assert.deepEqual(poses.unpacked([both]), []);
});

test("other messages are left as they are", () => {
  const others = [{ type: "GuiUpdateMessage" }, { type: "SetPositionMessage", name: "/x" }];
  assert.equal(poses.unpacked(others), others);
});

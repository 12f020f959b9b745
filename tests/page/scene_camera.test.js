// The scene in the pictures of cameras: each point of it is at its pixel of the image.

import assert from "node:assert/strict";
import { test } from "node:test";

import { framing, Settling } from "../../src/sambot_viz/page/view/scene_camera.js";

const NEAR = 0.01;
const VIEW = {
  position: [0, 0, 0],
  wxyz: [1, 0, 0, 0],
  focus: [200, 210],
  center: [150, 110],
  size: [320, 240],
  roi: [0, 0, 0, 0],
  zoom: 1,
  far: 100,
  behind: true,
  over: 0.5,
  hidden: [],
};
/** Points that the camera sees: x to the right, y downwards, z forward [m]. */
const POINTS = [
  [0, 0, 1],
  [-0.7, 0.5, 2],
  [3, -2, 5],
];

/** @param {number} found @param {number} wanted */
const near = (found, wanted) => assert.ok(Math.abs(found - wanted) < 1e-6, `${found} ≠ ${wanted}`);

/** Where OpenGL draws a point of a window, for the sides of what is seen at the near plane.
 * @param {number[]} sides @param {number[]} point @param {number} width @param {number} height */
function drawn([left, right, top, bottom], [x, y, z], width, height) {
  const across = (2 * NEAR * x) / (right - left) / z - (right + left) / (right - left);
  const up = (2 * NEAR * -y) / (top - bottom) / z - (top + bottom) / (top - bottom);
  return [((1 + across) * width) / 2, ((1 - up) * height) / 2];
}

for (const [width, height] of [
  [640, 480],
  [377, 580],
  [900, 200],
])
  for (const zoom of [1, 2.5, 0.2])
    test(`points are at their pixels, ${width} × ${height}, zoom ${zoom}`, () => {
      const frame = framing({ ...VIEW, zoom }, width, height);
      assert.ok(frame);
      const [left, top, across, down] = frame.image;
      for (const point of POINTS) {
        const [x, y] = drawn(frame.sides, point, width, height);
        near(x, left + ((200 * (point[0] / point[2]) + 150) / 320) * across);
        near(y, top + ((210 * (point[1] / point[2]) + 110) / 240) * down);
      }
    });

test("the whole image is in the window, as large as it may be", () => {
  // A pixel of this camera is as wide as it is high when its image is 320/200 to 240/210.
  const wide = framing(VIEW, 1000, 100);
  const high = framing(VIEW, 100, 1000);
  assert.deepEqual(wide?.image.slice(1).map(Math.round), [0, 140, 100]);
  assert.deepEqual(high?.image.map(Math.round), [0, 464, 100, 71]);
});

test("a part of the image is drawn at its place", () => {
  const part = framing(
    { ...VIEW, focus: [1, 1], size: [100, 50], roi: [20, 10, 40, 20] },
    200,
    100,
  );
  part?.image.forEach((found, n) => near(found, [40, 20, 80, 40][n]));
});

test("a camera without numbers has no window", () => {
  assert.equal(framing({ ...VIEW, focus: [0, 0] }, 100, 100), null);
  assert.equal(framing({ ...VIEW, size: [0, 0] }, 100, 100), null);
  assert.equal(framing({ ...VIEW, center: [1e308, 0], zoom: 1e5 }, 100, 100), null);
});

test("what a message has brought is drawn, however seldom the page draws", () => {
  const settling = new Settling();
  assert.ok(!settling.picture(10_000));
  settling.note(10_000);
  // viser takes a message up in one picture and shows it in the next; each takes a second here.
  assert.deepEqual(
    [11_000, 12_000, 13_000, 14_000].map((now) => settling.picture(now)),
    [true, true, true, false],
  );
  settling.note(20_000);
  const often = [...Array(20).keys()].map((n) => settling.picture(20_000 + 20 * n));
  assert.ok(often.every(Boolean));
  assert.ok(!settling.picture(20_600));
});

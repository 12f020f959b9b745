// What a page without a view says to viser.

import assert from "node:assert/strict";
import { test } from "node:test";

const { firstCamera } = await import("../../src/sambot_viz/page/wire/viser_socket.js");

/** Read MessagePack, as far as it is used. @param {Uint8Array} bytes */
function decoded(bytes) {
  const view = new DataView(bytes.buffer);
  let at = 0;
  /** @returns {any} */
  const next = () => {
    const kind = view.getUint8(at++);
    if (kind === 0xcb) return view.getFloat64((at += 8) - 8);
    if (kind === 0xcd) return view.getUint16((at += 2) - 2);
    if (kind >> 5 === 5) {
      const end = at + (kind & 31);
      return new TextDecoder().decode(bytes.subarray(at, (at = end)));
    }
    if (kind >> 4 === 9) return Array.from({ length: kind & 15 }, next);
    if (kind >> 4 === 8)
      return Object.fromEntries(Array.from({ length: kind & 15 }, () => [next(), next()]));
    throw new Error(`kind ${kind} at ${at}`);
  };
  const found = next();
  assert.equal(at, bytes.length);
  return found;
}

test("the camera of a page that viser has just opened is reported", () => {
  const camera = decoded(firstCamera(1280, 720));
  assert.equal(camera.type, "ViewerCameraMessage");
  assert.deepEqual([camera.image_width, camera.image_height], [1280, 720]);
  assert.deepEqual(
    [camera.position, camera.look_at],
    [
      [3, 3, 3],
      [0, 0, 0],
    ],
  );
  // The z axis of the camera, which looks along it, leads from there to the origin.
  const [w, x, y, z] = camera.wxyz;
  const forward = [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)];
  for (const part of forward) assert.ok(Math.abs(part + Math.sqrt(1 / 3)) < 1e-6);
  const down = [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)];
  assert.ok(down[2] < -0.8 && Math.abs(down[0] - down[1]) < 1e-6);
});

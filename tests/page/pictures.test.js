// Pictures of cameras: of those that come too fast, the last one is drawn.

import assert from "node:assert/strict";
import { test } from "node:test";

import { Pictures, unpacked } from "../../src/sambot_viz/page/wire/pictures.js";

/** @param {any} about @param {number[]} content */
function frame(about, content) {
  const head = new TextEncoder().encode(JSON.stringify(about));
  return new Uint8Array([2, head.length, 0, 0, 0, ...head, ...content]).buffer;
}

test("a frame is what it is about, and a file", async () => {
  const about = { id: "a", type: "image/png", width: 2, height: 1 };
  const { file, ...rest } = unpacked(frame(about, [1, 2, 3]));
  assert.deepEqual(rest, about);
  assert.equal(file?.type, "image/png");
  assert.deepEqual([...new Uint8Array((await file?.arrayBuffer()) || [])], [1, 2, 3]);
  assert.equal(unpacked(frame({ ...about, type: "" }, [])).file, undefined);
});

test("while one is decoded the newest waits, and the others are left out", async () => {
  /** @type {((bitmap: any) => void)[]} */
  const decodes = [];
  /** @type {any[]} */
  const drawn = [];
  const pictures = new Pictures(() => new Promise((done) => decodes.push(done)));
  pictures.follow("a", (bitmap, broken) => drawn.push([/** @type {any} */ (bitmap)?.n, broken]));
  const picture = { id: "a", type: "image/png", width: 1, height: 1, file: new Blob() };
  const all = [picture, picture, { ...picture, type: "", file: undefined }, picture].map((one) =>
    pictures.take(one),
  );
  assert.equal(decodes.length, 1);
  decodes[0]({ n: 1, close() {} });
  while (decodes.length < 2) await new Promise((done) => setImmediate(done));
  decodes[1]({ n: 4, close() {} });
  await Promise.all(all);
  assert.deepEqual(drawn, [
    [1, false],
    [4, false],
  ]);
});

test("a picture that the browser cannot read is said to be broken", async () => {
  /** @type {any[]} */
  const drawn = [];
  const pictures = new Pictures(() => Promise.reject(new Error("no")));
  const end = pictures.follow("a", (bitmap, broken) => drawn.push([bitmap, broken]));
  const picture = { id: "a", type: "image/png", width: 1, height: 1, file: new Blob() };
  await pictures.take(picture);
  end();
  await pictures.take(picture);
  assert.deepEqual(drawn, [[null, true]]);
});

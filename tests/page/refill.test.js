// Points that come again: what is drawn gets their places and colours, unless they look otherwise.

import assert from "node:assert/strict";
import { test } from "node:test";
import { pointsOf, refilling } from "../../src/sambot_viz/page/view/refill.js";

class Attribute {
  /** @param {any} array @param {number} itemSize @param {boolean} normalized */
  constructor(array, itemSize, normalized) {
    Object.assign(this, { array, itemSize, normalized });
  }
}

const STYLE = { drawAs: "points", shape: "Boxes", size: [1, 1, 1], alpha: 1 };

/** A file of points, at an address that fits no float.
 * @param {number[]} points @param {number[] | null} colors @param {any} [style] @param {string} [alphaMode] */
function file(points, colors, style = STYLE, alphaMode = "OPAQUE") {
  const parts = [new Uint8Array(new Float32Array(points).buffer), new Uint8Array(colors || [])];
  const offsets = [0, parts[0]?.length || 0];
  const attributes = colors ? { POSITION: 0, COLOR_0: 1 } : { POSITION: 0 };
  const document = {
    meshes: [{ extras: style, primitives: [{ attributes }] }],
    materials: [{ alphaMode }],
    accessors: parts.map((_, n) => ({ bufferView: n, count: points.length / 3 })),
    bufferViews: parts.map((part, n) => ({ byteOffset: offsets[n], byteLength: part.length })),
  };
  const head = new TextEncoder().encode(JSON.stringify(document));
  const body = parts.flatMap((part) => [...part]);
  const bytes = new Uint8Array(1 + 28 + head.length + body.length);
  const view = new DataView(bytes.buffer, 1);
  view.setUint32(0, 0x46546c67, true);
  view.setUint32(12, head.length, true);
  bytes.set(head, 1 + 20);
  bytes.set(body, 1 + 28 + head.length);
  return bytes.subarray(1);
}

/** What is drawn of a file. @param {number[]} points @param {number[] | null} colors @param {any} [style] */
function drawn(points, colors, style = STYLE) {
  const geometry = {
    attributes: /** @type {any} */ ({ center: new Attribute(new Float32Array(points), 3, false) }),
    instanceCount: points.length / 3,
    disposed: 0,
    dispose: () => (geometry.disposed += 1),
    setAttribute: (/** @type {string} */ name, /** @type {any} */ one) =>
      (geometry.attributes[name] = one),
  };
  if (colors) geometry.attributes.tint = new Attribute(new Uint8Array(colors), 4, true);
  return { userData: { ...style, name: "p" }, material: { transparent: false }, geometry };
}

test("other points take the places of those before, and fewer are fewer", () => {
  const object = drawn([1, 2, 3, 4, 5, 6], [1, 2, 3, 4, 5, 6, 7, 8]);
  const { center, tint } = object.geometry.attributes;
  const fill = refilling(object, file([7, 8, 9], [9, 9, 9, 9]));
  // Not before the picture in which they are seen.
  assert.deepEqual([...center.array], [1, 2, 3, 4, 5, 6]);
  fill?.();
  assert.deepEqual([...center.array].slice(0, 3), [7, 8, 9]);
  assert.deepEqual([...tint.array].slice(0, 4), [9, 9, 9, 9]);
  assert.equal(object.geometry.instanceCount, 1);
  assert.ok(center.needsUpdate && tint.needsUpdate && !object.geometry.disposed);
});

test("more points have buffers of their own, with room for a few more", () => {
  const object = drawn([1, 2, 3], null);
  const many = Array.from({ length: 300 }, (_, n) => n);
  refilling(object, file(many, null))?.();
  const { center } = object.geometry.attributes;
  assert.deepEqual([...center.array].slice(0, 300), many);
  assert.ok(center.array.length > 300 && center.array.length % 3 === 0);
  assert.deepEqual([center.isInstancedBufferAttribute, center.meshPerAttribute], [true, 1]);
  assert.deepEqual([object.geometry.disposed, object.geometry.instanceCount], [1, 100]);
  refilling(object, file([...many, 1, 2, 3], null))?.();
  assert.deepEqual([object.geometry.disposed, object.geometry.instanceCount], [1, 101]);
});

test("what looks otherwise is viser's", () => {
  const points = [1, 2, 3];
  const object = drawn(points, null);
  assert.ok(refilling(object, file(points, null)));
  for (const style of [
    { ...STYLE, alpha: 0.5 },
    { ...STYLE, size: [1, 1, 2] },
    { ...STYLE, color: [1, 2, 3, 4] },
    { ...STYLE, drawAs: "lines" },
  ])
    assert.equal(refilling(object, file(points, null, style)), null);
  assert.equal(refilling(object, file(points, [1, 2, 3, 4])), null);
  assert.equal(refilling(object, file(points, null, STYLE, "BLEND")), null);
  assert.equal(refilling(object, new Uint8Array(4)), null);
  assert.equal(refilling(object, new Uint8Array(40)), null);
  assert.equal(
    refilling(drawn(points, null, { ...STYLE, color: [1, 2, 3, 4] }), file(points, null)),
    null,
  );
});

test("a node has points once they were dressed", () => {
  const object = drawn([1, 2, 3], null);
  const node = (/** @type {any[]} */ ...children) => ({ userData: {}, children });
  assert.equal(pointsOf(node(node(node(), object))), object);
  assert.equal(pointsOf(node(node({ ...object, geometry: { attributes: {} } }))), null);
  // Those of a node below are not its own.
  assert.equal(pointsOf(node(node(), node(node(object)))), null);
  assert.equal(pointsOf(undefined), null);
});

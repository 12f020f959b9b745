// What viser gets for a picture, and which pictures are left out until all of it is there.

import assert from "node:assert/strict";
import { test } from "node:test";

/** viser's queue, and what it has taken from it in this order. */
const queue = /** @type {any[]} */ ([]);
const taken = /** @type {any[]} */ ([]);
/** What a picture does, by its priority; 0 is whether it is drawn. */
const steps = /** @type {[number, () => void][]} */ ([]);
const internal = {
  priority: 0,
  subscribe: (/** @type {any} */ { current }, /** @type {number} */ priority) => {
    steps.push([priority, current]);
  },
};
/** Files that are being read; viser takes a node away until its file is there. */
const nodes = /** @type {Record<string, any>} */ ({});
const viser = {
  messageQueue: queue,
  firstMessageBatch: false,
  nodeRefFromName: nodes,
  requestRender() {},
  drainMessageQueue() {
    if (!queue.length) return;
    for (const message of queue.splice(0, queue.length)) {
      taken.push(message);
      if (message.updates?.glb_data) nodes[message.name] = null;
    }
  },
};
let clock = 0;
performance.now = () => clock;
Object.assign(globalThis, { window: { __viserMutable: viser }, document: { hidden: false } });
const { drawTogether, followMessages, parted } =
  await import("../../src/sambot_viz/page/view/messages.js");
while (!Object.hasOwn(queue, "splice")) await new Promise((then) => setTimeout(then, 5));
const state = () => ({ internal });
drawTogether({ __r3f: { root: { getState: state } } });
steps.push([-100000, () => viser.drainMessageQueue()]);
steps.sort(([a], [b]) => a - b);

/** Begin a picture; returns whether it is drawn. */
function picture() {
  for (const [, step] of steps) step();
  return internal.priority === 0;
}
/** What viser takes meanwhile. @param {() => unknown} act */
async function taking(act) {
  taken.length = 0;
  await act();
  await Promise.resolve();
  return taken.map(({ id }) => id);
}
const pose = (/** @type {string} */ name, /** @type {unknown} */ id = name) => ({
  type: "SetPositionMessage",
  name,
  id,
});
const file = (/** @type {string} */ name, id = `${name} file`) => ({
  type: "SceneNodeUpdateMessage",
  name,
  id,
  updates: { glb_data: new Uint8Array(1) },
});
const removal = (/** @type {string} */ name) => ({ type: "RemoveSceneNodeMessage", name, id: -1 });

/** Nothing waits. */
async function begin() {
  document.hidden = false;
  clock += 1000;
  while (queue.length || !picture()) await Promise.resolve();
  picture();
  await Promise.resolve();
}

test("poses come with the picture in which the files that came with them are read", async () => {
  await begin();
  assert.deepEqual(await taking(() => queue.push(pose("/a"), file("/b"))), ["/b file"]);
  assert.equal(picture(), false);
  assert.deepEqual(await taking(picture), []);
  nodes["/b"] = {};
  assert.deepEqual(await taking(picture), ["/a"]);
  assert.equal(internal.priority, 0);
});

test("what comes meanwhile is handed on after that picture", async () => {
  await begin();
  await taking(() => queue.push(pose("/a", 1), file("/b")));
  assert.deepEqual(await taking(() => queue.push(pose("/a", 2), file("/b", "next"))), []);
  nodes["/b"] = {};
  assert.deepEqual(await taking(picture), [1, "next"]);
  assert.equal(picture(), false);
  nodes["/b"] = {};
  assert.deepEqual(await taking(picture), [2]);
});

test("poses alone wait for nothing", async () => {
  await begin();
  assert.deepEqual(await taking(() => queue.push(pose("/a"))), []);
  assert.deepEqual(await taking(picture), ["/a"]);
  assert.equal(internal.priority, 0);
});

test("what comes in several parts waits for the last one, but not for long", async () => {
  await begin();
  const more = pose("~more");
  assert.deepEqual(await taking(() => queue.push(pose("/a"), more)), []);
  assert.deepEqual(await taking(picture), []);
  assert.deepEqual(await taking(() => queue.push(file("/b"), more)), []);
  assert.deepEqual(await taking(() => queue.push(file("/c"))), ["/b file", "/c file"]);
  Object.assign(nodes, { "/b": {}, "/c": {} });
  assert.deepEqual(await taking(picture), ["/a"]);
  await taking(() => queue.push(pose("/a"), file("/b"), more));
  for (let i = 0; i < 2; i += 1) {
    clock += 201;
    assert.deepEqual(await taking(picture), []);
  }
  assert.deepEqual(await taking(picture), ["/b file"]);
  nodes["/b"] = {};
  assert.deepEqual(await taking(picture), ["/a"]);
});

test("a file that takes too long comes later", async () => {
  await begin();
  await taking(() => queue.push(pose("/a"), file("/b")));
  for (let i = 0; i < 3; i += 1) {
    clock += 201;
    assert.equal(picture(), false);
  }
  assert.deepEqual(await taking(picture), ["/a"]);
  assert.equal(internal.priority, 0);
});

test("a hidden page takes all at once", async () => {
  await begin();
  await taking(() => queue.push(pose("/a"), file("/b")));
  document.hidden = true;
  const all = () => {
    queue.push(pose("/c"));
    viser.drainMessageQueue();
  };
  assert.deepEqual(await taking(all), ["/a", "/c"]);
});

test("a picture that somebody asks for has all that was said before", async () => {
  await begin();
  const asked = { type: "GetRenderRequestMessage", id: "picture" };
  assert.deepEqual(await taking(() => queue.push(pose("/a"), file("/b"), asked)), []);
  assert.deepEqual(await taking(picture), ["/a", "/b file", "picture"]);
  // Whatever is waited for.
  await taking(() => queue.push(pose("/a"), file("/b")));
  queue.push(pose("/c"), asked);
  assert.deepEqual(await taking(picture), ["/a", "/c", "picture"]);
  assert.equal(queue.length, 0);
});

test("what is heard of messages is what viser takes", async () => {
  await begin();
  const heard = /** @type {any[]} */ ([]);
  const end = followMessages((messages) => heard.push(...messages.map(({ id }) => id)));
  await taking(() => queue.push(pose("/a"), file("/b")));
  assert.deepEqual(heard, ["/b file"]);
  nodes["/b"] = {};
  picture();
  end();
  assert.deepEqual(heard, ["/b file", "/a"]);
});

test("poses and files of a node that goes are not those of the next one", () => {
  const made = { type: "FrameMessage", name: "/a", props: {} };
  const other = pose("/ab");
  const old = [pose("/a"), pose("/a/b"), other, file("/a/b")];
  const { poses, rest, files } = parted([...old, removal("/a"), made, pose("/a", "new")]);
  assert.deepEqual(poses, [other, pose("/a", "new")]);
  assert.deepEqual(rest, [file("/a/b"), pose("/a"), pose("/a/b"), removal("/a"), made]);
  assert.equal(files.size, 0);
  const again = parted([pose("/a"), pose("/a/b"), made]);
  assert.deepEqual(again, { poses: [pose("/a/b")], rest: [pose("/a"), made], files: new Set() });
});

/** A node that draws points, and a file with others. */
const dots = (/** @type {number} */ x) => {
  const document = {
    meshes: [{ extras: { drawAs: "points" }, primitives: [{ attributes: { POSITION: 0 } }] }],
    materials: [{ alphaMode: "OPAQUE" }],
    accessors: [{ bufferView: 0, count: 1 }],
    bufferViews: [{ byteOffset: 0, byteLength: 12 }],
  };
  const head = new TextEncoder().encode(JSON.stringify(document));
  const bytes = new Uint8Array(40 + head.length);
  const view = new DataView(bytes.buffer);
  view.setUint32(0, 0x46546c67, true);
  view.setUint32(12, head.length, true);
  bytes.set(head, 20);
  view.setFloat32(28 + head.length, x, true);
  return { type: "SceneNodeUpdateMessage", name: "/p", id: x, updates: { glb_data: bytes } };
};
const cloud = (/** @type {any} */ more = {}) => {
  const center = { array: new Float32Array(3) };
  const one = { userData: { drawAs: "points" }, material: { transparent: false } };
  const object = { ...one, geometry: { attributes: { center } }, ...more };
  return { center, children: [{ children: [object] }] };
};
const begun = (/** @type {any} */ props = {}) => ({ type: "GlbMessage", name: "/p", id: 0, props });

test("points that come again are in the picture of the poses, and viser does not read them", async () => {
  await begin();
  const props = { glb_data: null };
  await taking(() => queue.push(begun(props)));
  const node = (nodes["/p"] = cloud());
  picture();
  assert.deepEqual(await taking(() => queue.push(pose("/a"), dots(5))), []);
  assert.equal(node.center.array[0], 0);
  assert.deepEqual(await taking(picture), ["/a"]);
  assert.equal(node.center.array[0], 5);
  // Whatever makes viser read the file again, it is this one.
  assert.deepEqual(props.glb_data, dots(5).updates.glb_data);
  assert.equal(internal.priority, 0);
});

test("points of a node that is made or read anew are viser's", async () => {
  await begin();
  const node = (nodes["/p"] = cloud());
  // Nobody knows what viser has made of it.
  assert.deepEqual(await taking(() => queue.push(removal("/p"), begun(), dots(1))), [-1, 0, 1]);
  picture();
  await begin();
  // The object that is there gives way to that of the file that is read.
  nodes["/p"] = node;
  assert.deepEqual(await taking(() => queue.push(dots(2))), [2]);
  await begin();
  nodes["/p"] = cloud();
  assert.deepEqual(await taking(() => queue.push(dots(3))), []);
  await begin();
  assert.equal(node.center.array[0], 0);
  assert.equal(nodes["/p"].center.array[0], 3);
});

test("a page without a view does not wait for one", async () => {
  const { setInterval, location } = globalThis;
  let begun = 0;
  const count = () => (begun += 1);
  for (const search of ["?token=a", "?view=none"]) {
    Object.assign(globalThis, { location: { search }, setInterval: count });
    await import(`../../src/sambot_viz/page/view/messages.js${search}`);
  }
  Object.assign(globalThis, { setInterval, location });
  assert.equal(begun, 1);
});

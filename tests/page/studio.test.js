import assert from "node:assert/strict";
import { test } from "node:test";
import { beginShapes, putBack, roundOff } from "../../src/sambot_viz/page/view/studio_shapes.js";
import { drawShadow, dropShadow } from "../../src/sambot_viz/page/view/studio_shadow.js";

/** An attribute of a geometry, as three.js has them. */
class Values {
  constructor(array, size) {
    Object.assign(this, { array, size, itemSize: size, count: array.length / size });
  }
  getX = (i) => this.array[i * this.size];
  getY = (i) => this.array[i * this.size + 1];
  getZ = (i) => this.array[i * this.size + 2];
}
let made = 0;
class Geometry {
  type = "BufferGeometry";
  attributes = {};
  index = null;
  scaled = [1, 1, 1];
  id = (made += 1);
  setAttribute(name, values) {
    this.attributes[name] = values;
  }
  setIndex(index) {
    this.index = index;
  }
  scale(...by) {
    this.scaled = by;
  }
  clone = () => new Geometry();
  deleteAttribute(name) {
    delete this.attributes[name];
  }
  /** What went with it, as in three.js. */
  gone = null;
  dispose() {
    this.gone = Object.keys(this.attributes);
  }
}
class CylinderGeometry extends Geometry {
  type = "CylinderGeometry";
  parameters = { radiusTop: 0.1, radiusBottom: 0.1, height: 0.4 };
}

/** A lit shape with corners at a place. */
function shape(Kind, corners, at = [0, 0, 0]) {
  const geometry = new Kind();
  geometry.attributes.position = new Values(Float32Array.from(corners.flat()), 3);
  geometry.index = new Values(Uint16Array.from([0, 1, 2]), 1);
  const elements = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, ...at, 1];
  const material = { flatShading: true, opacity: 1, needsUpdate: false };
  return { geometry, material, matrixWorld: { elements } };
}
const signs = [-0.5, 0.5];
const cube = signs.flatMap((x) => signs.flatMap((y) => signs.map((z) => [x, y, z])));
const ball = Array.from({ length: 114 }, (_, i) => {
  const [z, angle] = [1 - (2 * i + 1) / 114, 2.4 * i];
  const r = Math.sqrt(1 - z * z);
  return [r * Math.cos(angle), r * Math.sin(angle), z].map((v) => v / 2);
});

test("RViz's sphere and cylinder become round with normals, and what they were again", () => {
  beginShapes();
  for (const [object, size] of [
    [shape(Geometry, ball), [1, 1, 1]],
    [shape(CylinderGeometry, cube), [0.2, 0.4, 0.2]],
  ]) {
    const { geometry } = object;
    roundOff(object);
    assert.notEqual(object.geometry, geometry);
    assert.equal(object.material.flatShading, false);
    assert.deepEqual(object.geometry.scaled, size);
    const { position, normal } = object.geometry.attributes;
    assert.ok(position.count > geometry.attributes.position.count && normal.count > 0);
    for (let i = 0; i < normal.count; i += 1) {
      const length = Math.hypot(normal.getX(i), normal.getY(i), normal.getZ(i));
      assert.ok(Math.abs(length - 1) < 1e-3);
    }
    assert.ok(object.geometry.index.array.every((corner) => corner < position.count));
    putBack(object);
    assert.equal(object.geometry, geometry);
    assert.equal(object.material.flatShading, true);
  }
});

test("a batch keeps the numbers of its instances when its round geometry goes", () => {
  beginShapes();
  const batch = { ...shape(Geometry, ball), isInstancedMesh: true };
  const { geometry } = batch;
  roundOff(batch);
  const round = batch.geometry;
  round.setAttribute("instanceIndex", "of the batch");
  round.setAttribute("position", "its own");
  putBack(batch);
  assert.equal(batch.geometry, geometry);
  assert.deepEqual(round.gone, ["position"]);
});

test("a shape that is made once is used for all that are the same", () => {
  beginShapes();
  const one = shape(Geometry, ball);
  const other = { ...one, material: { ...one.material } };
  roundOff(one);
  roundOff(other);
  assert.equal(one.geometry, other.geometry);
});

/** What the corners of a mesh can have besides their places. */
const EXTRAS = {
  uv: () =>
    new Values(
      Float32Array.from({ length: 8 }, (_, i) => i / 8),
      2,
    ),
  color: () =>
    new Values(
      Uint8Array.from({ length: 16 }, (_, i) => 10 * i),
      4,
    ),
};
/** The numbers of the corners of a geometry, face by face. */
function byCorner({ attributes, index }, name) {
  const { array, size, count } = attributes[name];
  const corners = index ? [...index.array] : Array.from({ length: count }, (_, i) => i);
  return corners.map((corner) => [...array.slice(size * corner, size * corner + size)]);
}

test("a mesh that becomes smooth keeps what its corners have, in its own kind of numbers", () => {
  for (const extras of [[], ["uv"], ["color"], ["uv", "color"]]) {
    for (const faces of [null, [0, 1, 2, 0, 2, 3]]) {
      beginShapes();
      const flat = shape(Geometry, [...cube.slice(0, 3), cube[5]]);
      const { geometry } = flat;
      geometry.index = faces && new Values(Uint16Array.from(faces), 1);
      geometry.groups = [{ start: 0, count: 3, materialIndex: 1 }];
      for (const name of extras) geometry.attributes[name] = EXTRAS[name]();
      if (!faces) {
        // Without an index, a mesh of four corners has one face.
        for (const values of Object.values(geometry.attributes)) values.count = 3;
      }
      roundOff(flat);
      const smooth = flat.geometry;
      assert.notEqual(smooth, geometry);
      for (const name of ["position", ...extras]) {
        assert.deepEqual(byCorner(smooth, name), byCorner(geometry, name), name);
        const [now, before] = [smooth, geometry].map((one) => one.attributes[name].array);
        assert.equal(now.constructor, before.constructor);
      }
      assert.deepEqual(smooth.groups, geometry.groups);
    }
  }
});

test("a textured or coloured mesh with the corners of a sphere stays a mesh", () => {
  for (const name of ["uv", "color"]) {
    beginShapes();
    const mesh = shape(Geometry, ball);
    mesh.geometry.attributes[name] = new Values(new Float32Array(114 * 3), 3);
    roundOff(mesh);
    assert.equal(mesh.geometry.attributes.position.count, 3);
    assert.equal(mesh.geometry.attributes[name].count, 3);
  }
});

/** A scene, and the object that the background is drawn on; what is painted is counted. */
function stage() {
  const painted = { count: 0 };
  const context = {
    clearRect: () => (painted.count += 1),
    ...{ beginPath() {}, closePath() {}, moveTo() {}, lineTo() {}, fill() {} },
  };
  globalThis.document = { createElement: () => ({ getContext: () => context }) };
  class Picture {}
  class Material {
    uniforms = { colorMap: { value: new Picture() } };
  }
  class Mesh {
    constructor(geometry, material) {
      Object.assign(this, { geometry, material, rotation: {}, parent: null, moves: 0 });
      this.position = { set: (...at) => (this.at = at) };
      this.scale = { set: (...size) => (this.size = size) };
    }
    updateMatrixWorld() {
      this.moves += 1;
    }
    removeFromParent() {
      this.parent = null;
    }
  }
  const scene = {
    add(mesh) {
      mesh.parent = scene;
      scene.shadow = mesh;
    },
  };
  return { scene, background: new Mesh(new Geometry(), new Material()), painted };
}

test("the shadow lies below the robot and is painted only when a shape has moved", () => {
  const { scene, background, painted } = stage();
  const objects = [shape(Geometry, cube, [2, 1.5, 0]), shape(Geometry, cube, [2, 3, 0])];
  drawShadow(scene, background, objects);
  const { shadow } = scene;
  assert.equal(painted.count, 1);
  assert.equal(shadow.visible, true);
  assert.deepEqual([shadow.at[0], shadow.at[2]], [2, 0]);
  assert.ok(shadow.at[1] < 1 && shadow.at[1] > 0.99);
  assert.ok(shadow.size[0] > 1 && shadow.size[0] < 2);
  // Pictures of a robot at rest, from wherever they are.
  for (let i = 0; i < 5; i += 1) drawShadow(scene, background, objects);
  assert.equal(painted.count, 1);
  assert.equal(shadow.moves, 1);
  objects[1].matrixWorld.elements[12] = 2.5;
  // Where it is slow it follows in steps, and says so until it has.
  while (drawShadow(scene, background, objects)) assert.equal(painted.count, 1);
  assert.equal(painted.count, 2);
  assert.equal(drawShadow(scene, background, objects), false);
  assert.equal(painted.count, 2);
  // Nothing has no shadow, and RViz's look none at all.
  drawShadow(scene, background, []);
  assert.equal(shadow.visible, false);
  dropShadow();
  assert.equal(shadow.parent, null);
});

/** A mesh of triangles, without an index, and its normals when it is smooth, one for each corner. */
function smoothNormals(triangles) {
  const geometry = new Geometry();
  geometry.attributes.position = new Values(Float32Array.from(triangles.flat(2)), 3);
  const object = { geometry, material: { flatShading: true, needsUpdate: false } };
  beginShapes();
  roundOff(object);
  assert.notEqual(object.geometry, geometry);
  const { array } = object.geometry.attributes.normal;
  return Array.from({ length: array.length / 3 }, (_, i) => [...array.subarray(3 * i, 3 * i + 3)]);
}

test("corners that are at other places have nothing to do with each other", () => {
  // A thousand triangles that touch nothing, each tilted in its own way.
  let seed = 1;
  const random = () => (seed = (seed * 16807) % 2147483647) / 2147483647 - 0.5;
  const tilts = Array.from({ length: 1000 }, () => [random() / 2, random() / 2]);
  const triangles = tilts.map(([a, b]) => {
    const [x, y, z] = [100 * random(), 100 * random(), 100 * random()];
    return [
      [x, y, z],
      [x + 0.1, y, z + 0.1 * a],
      [x, y + 0.1, z + 0.1 * b],
    ];
  });
  smoothNormals(triangles).forEach((normal, i) => {
    const [a, b] = tilts[Math.floor(i / 3)];
    const long = Math.hypot(a, b, 1);
    const own = [-a / long, -b / long, 1 / long];
    own.forEach((value, k) => assert.ok(Math.abs(normal[k] - value) < 1e-3, `${i}: ${normal}`));
  });
});

test("the middle of a fan of thousands is smooth, and an edge beside it stays one", () => {
  const sides = 3000;
  const rim = (i) => [Math.cos((2 * Math.PI * i) / sides), Math.sin((2 * Math.PI * i) / sides)];
  const disc = Array.from({ length: sides }, (_, i) => [
    [0, 0, 0],
    [...rim(i), 0],
    [...rim(i + 1), 0],
  ]);
  // A wall that meets the middle.
  const wall = [
    [0, 0, 0],
    [1, 0, 0],
    [0, 0, 1],
  ];
  const normals = smoothNormals([...disc, wall]);
  const z = [0, 0, 1];
  for (const normal of normals.slice(0, -3))
    z.forEach((value, k) => assert.ok(Math.abs(normal[k] - value) < 1e-4));
  for (const normal of normals.slice(-3)) assert.ok(Math.abs(normal[1] + 1) < 1e-4);
});

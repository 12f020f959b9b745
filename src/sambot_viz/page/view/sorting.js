// @ts-check
/* The order of what can be seen through. RViz draws it from far to near by the distance of the
 * origins; three.js goes by their depth along the view, which is another order, and leaves the
 * copies of a batch as they are.
 */

/** The camera's matrixWorld. @type {any} */
export let eye = null;

/** Say where a picture is seen from. @param {any} matrixWorld of the camera */
export function lookFrom(matrixWorld) {
  eye = matrixWorld;
}

/** The squared distance from the camera. @param {number} x @param {number} y @param {number} z */
function distanceOf(x, y, z) {
  const e = eye.elements;
  return (x - e[12]) ** 2 + (y - e[13]) ** 2 + (z - e[14]) ** 2;
}

/** @param {any} object */
function distance(object) {
  const m = object.matrixWorld.elements;
  return distanceOf(m[12], m[13], m[14]);
}

/** Compare two objects that three.js is to draw. @param {any} a @param {any} b */
export const farFirst = (a, b) =>
  a.groupOrder - b.groupOrder ||
  a.renderOrder - b.renderOrder ||
  distance(b.object) - distance(a.object) ||
  a.id - b.id;

/** Batches that can be seen through, each with what sorts it. @type {WeakMap<object, any>} */
const sorting = new WeakMap();

/** @param {any} batch */
const sorted = (batch) => (/** @type {{index: number, depth: number}[]} */ copies) => {
  for (const copy of copies) {
    const { x, y, z } = batch.getPositionAt(copy.index).applyMatrix4(batch.matrixWorld);
    copy.depth = distanceOf(x, y, z);
  }
  copies.sort((a, b) => b.depth - a.depth);
};

/** Draw the copies of a batch that can be seen through from far to near. @param {any} object */
export function sortBatch(object) {
  if (!object.isInstancedMesh2 || !object.material.transparent) return;
  if (!sorting.has(object)) sorting.set(object, sorted(object));
  object.customSort = sorting.get(object);
  object.sortObjects = true;
}

// @ts-check
/* What the server draws beyond viser's nodes: GLB files whose `extras` say in `drawAs` what makes
 * a picture of their vertices (displays/scene/glb_node.py). A kind is one function, which is given
 * its objects before each picture.
 */

import { dressGroup, nameGroup } from "./controls.js";
import { dressMap, dressTile } from "./maps.js";
import { dressPoints } from "./points.js";
import { dressRibbon } from "./ribbons.js";
import { rawColors } from "./raw_colors.js";
import { dressText } from "./texts.js";

/** Each is given its object, and the camera's matrixWorld.
 * @type {Record<string, (object: any, eye: any) => void>} */
const KINDS = {
  controlGroup: dressGroup,
  controls: nameGroup,
  lines: ({ material }) => rawColors(material, "lines"),
  map: dressMap,
  mark: dressMark,
  mapTile: dressTile,
  points: dressPoints,
  ribbon: dressRibbon,
  text: dressText,
  triangles: ({ material }) => rawColors(material, "lines"),
};

/** Let something be seen through everything; only the side that faces the eye.
 * @param {any} object */
function dressMark(object) {
  if (!rawColors(object.material, "lines")) return;
  object.material.depthTest = false;
  object.material.side = FRONT;
  object.renderOrder = ON_TOP + object.userData.above;
}
/** three.js's FrontSide. */
const FRONT = 0;
/** After all else that is drawn. */
const ON_TOP = 20;

const seen = new WeakSet();

/** Free what an object has on the graphics card when it goes: viser does so for meshes alone.
 * @param {any} object */
function freeWhenGone(object) {
  if (seen.has(object)) return;
  seen.add(object);
  object.parent?.addEventListener("removed", () => {
    object.geometry?.dispose();
    object.material?.dispose();
  });
}

/** Make a picture of an object, if it is one of ours. @param {any} object @param {any} eye */
export function dressDrawn(object, eye) {
  const kind = object.userData?.drawAs;
  if (kind === undefined) return;
  freeWhenGone(object);
  KINDS[kind]?.(object, eye);
}

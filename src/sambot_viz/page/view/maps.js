// @ts-check
/* Maps: squares whose texture has the value of each cell, and a palette that has the colours. So
 * another palette or alpha is a message of some bytes, whatever the size of the map.
 */

import { rawColors } from "./raw_colors.js";

/** Where in the order of all that is drawn a map is that is behind everything. */
const BEHIND = -1000;
/** From this alpha on RViz blends nothing. */
const OPAQUE_FROM = 0.9998;
/** Of three.js. */
const [NORMAL_BLENDING, CUSTOM_BLENDING] = [1, 5];

const LOOK_UP = `
float sCell = floor(texture2D(map, vMapUv).r * 255.0 + 0.5);
diffuseColor = texture2D(uPalette, vec2((sCell + 0.5) / 256.0, 0.5));
if (diffuseColor.a < 0.002) discard;
diffuseColor.a *= uAlpha;
`;

/**
 * What the squares of one map have in common.
 * @typedef {{behind: boolean, said: any, bytes: Uint8ClampedArray | null,
 *   palette: {value: any}, alpha: {value: number}}} Map2D
 */
/** @type {Map<string, Map2D>} */
const maps = new Map();

/** Read what a map looks like. @param {any} object */
export function dressMap({ userData }) {
  const known = maps.get(userData.map);
  if (known?.said === userData) return;
  const map = known || { palette: { value: null }, alpha: { value: 1 } };
  const bytes = Uint8ClampedArray.from(atob(userData.palette), (c) => c.charCodeAt(0));
  map.alpha.value = userData.alpha;
  maps.set(userData.map, Object.assign(map, { bytes, said: userData, behind: userData.behind }));
}

/** @param {Map2D} map @param {any} like a texture of three.js */
function makePalette(map, like) {
  if (!map.bytes) return;
  map.palette.value?.dispose();
  const texture = new like.constructor(new ImageData(/** @type {any} */ (map.bytes), 256, 1));
  texture.magFilter = texture.minFilter = like.magFilter;
  texture.generateMipmaps = false;
  texture.needsUpdate = true;
  map.palette.value = texture;
  map.bytes = null;
}

/** Draw a square of a map as its map looks now. @param {any} object */
export function dressTile(object) {
  const { material, userData } = object;
  const map = maps.get(userData.map);
  object.visible = Boolean(map && material.map);
  if (!map || !material.map) return;
  if (material.map.colorSpace) {
    // Its numbers are values of cells, not colours.
    material.map.colorSpace = "";
    material.map.generateMipmaps = false;
  }
  makePalette(map, material.map);
  rawColors(material, "map", (shader) => {
    shader.uniforms.uPalette = map.palette;
    shader.uniforms.uAlpha = map.alpha;
    shader.fragmentShader =
      "uniform sampler2D uPalette;\nuniform float uAlpha;\n" +
      shader.fragmentShader.replace("#include <map_fragment>", LOOK_UP);
  });
  const opaque = map.alpha.value >= OPAQUE_FROM;
  const blending = map.behind && !opaque ? CUSTOM_BLENDING : NORMAL_BLENDING;
  const transparent = !map.behind && !opaque;
  if (material.blending !== blending || material.transparent !== transparent) {
    // What is behind everything comes before what is opaque, and is blended all the same.
    Object.assign(material, { blending, transparent, needsUpdate: true });
  }
  material.depthWrite = opaque && !map.behind;
  // Away from the camera: lines in its plane are in front of it.
  Object.assign(material, { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 16 });
  object.renderOrder = map.behind ? BEHIND : 0;
}

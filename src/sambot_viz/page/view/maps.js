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
const [NEAREST, ONE_CHANNEL] = [1003, 1028];

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

/** The class of textures of three.js. @type {any} */
let Texture = null;

/** Read what a map looks like. @param {any} object */
export function dressMap(object) {
  const { material, userData } = object;
  object.visible = false;
  Texture = Texture || material.map?.constructor;
  const known = maps.get(userData.map);
  if (known?.said === userData) return;
  const map = known || { palette: { value: null }, alpha: { value: 1 } };
  const bytes = Uint8ClampedArray.from(atob(userData.palette), (c) => c.charCodeAt(0));
  map.alpha.value = userData.alpha;
  maps.set(userData.map, Object.assign(map, { bytes, said: userData, behind: userData.behind }));
}

/** @param {any} image @returns {any} */
function pixels(image) {
  const texture = new Texture(image);
  texture.magFilter = texture.minFilter = NEAREST;
  texture.generateMipmaps = texture.flipY = false;
  texture.needsUpdate = true;
  return texture;
}

/** @param {Map2D} map */
function makePalette(map) {
  if (!map.bytes) return;
  map.palette.value?.dispose();
  map.palette.value = pixels(new ImageData(/** @type {any} */ (map.bytes), 256, 1));
  map.bytes = null;
}

/**
 * Unpack the cells of a square.
 * @param {Uint8Array} packed the cells, or runs of them: a value, and how often it is there less one
 * @param {number} count of the cells
 */
export function unpack(packed, count) {
  if (packed.length === count) return packed;
  const cells = new Uint8Array(count);
  let at = 0;
  for (let i = 0; i < packed.length; i += 2) {
    cells.fill(packed[i], at, at + packed[i + 1] + 1);
    at += packed[i + 1] + 1;
  }
  return cells;
}

/** Make the texture of a square. @param {any} object */
function makeCells({ geometry, material, userData }) {
  const { rows: height, columns: width } = userData;
  const data = unpack(geometry.attributes._cells.array, width * height);
  // The graphics card has no use for it.
  geometry.deleteAttribute("_cells");
  const texture = pixels({ data, width, height });
  texture.isDataTexture = true;
  texture.format = ONE_CHANNEL;
  texture.unpackAlignment = 1;
  material.map = texture;
}

/** Draw a square of a map as its map looks now. @param {any} object */
export function dressTile(object) {
  const { material, userData } = object;
  const map = maps.get(userData.map);
  object.visible = Boolean(map && Texture);
  // Of a map that is not known yet, nothing must reach the graphics card.
  if (!map || !Texture) return;
  if (object.geometry.attributes._cells) makeCells(object);
  makePalette(map);
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
  // Away from the camera: lines in its plane are in front of it. Where depth is reversed three.js
  // turns the factor round, and not the units.
  Object.assign(material, { polygonOffset: true, polygonOffsetFactor: 1 });
  object.onBeforeRender = (/** @type {any} */ renderer) => {
    material.polygonOffsetUnits = renderer.capabilities.reversedDepthBuffer ? -16 : 16;
  };
  object.renderOrder = map.behind ? BEHIND : 0;
}

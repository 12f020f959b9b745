// @ts-check
/* Text that faces the view: a square as large in the scene as its letters, which are drawn once
 * into a texture.
 */

import { rawColors } from "./raw_colors.js";

/** Height of a line in the texture [pixels]. */
const CELL = 64;
/** The font's size by the height of a line. */
const EM = 0.889;
/** Where the letters stand in a line. */
const BASELINE = 0.87;
/** Above the first and below the last line, by the height of a line: tails of letters. */
const MARGIN = 0.03;
/** Between lines [m]. */
const GAP = 0.005;
/** Texture of the longest line [pixels]. */
const WIDEST = 4096;
/** Of three.js: smooth when it is drawn larger, and from halved pictures when smaller. */
const [LINEAR, LINEAR_MIPMAPS] = [1006, 1008];

const FACE = `
vec4 mvPosition = modelViewMatrix * vec4(0.0, 0.0, 0.0, 1.0);
mvPosition.xy += (vMapUv - 0.5) * vec2(uSize.x, -uSize.y);
gl_Position = projectionMatrix * mvPosition;
`;

/** @typedef {{lines: string[], height: number, space: number}} Said */

/**
 * Draw the lines of a text.
 * @param {Said} said
 * @returns {{canvas: HTMLCanvasElement, size: number[]}} and their size in the scene [m]
 */
export function drawText({ lines, height, space }) {
  const canvas = document.createElement("canvas");
  const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  const font = (/** @type {number} */ cell) => {
    context.font = `${EM * cell}px SambotNames, "Liberation Sans", Arial, sans-serif`;
    context.fillStyle = "#fff";
  };
  font(CELL);
  const words = lines.map((line) => line.split(" "));
  /** @param {string} word [m] */
  const wide = (word) => (context.measureText(word).width / CELL) * height;
  const widths = words.map((line) => line.map(wide));
  const width = Math.max(
    ...widths.map((line) => line.reduce((a, b) => a + b + space, -space)),
    1e-6 * height,
  );
  const pitch = height + GAP;
  const tall = lines.length * pitch - GAP + 2 * MARGIN * height;
  const scale = Math.min(CELL / height, WIDEST / width, WIDEST / tall);
  canvas.width = Math.max(1, Math.ceil(width * scale));
  canvas.height = Math.max(1, Math.ceil(tall * scale));
  // Another size of a canvas forgets its font.
  font(scale * height);
  words.forEach((line, row) => {
    let x = 0;
    line.forEach((word, i) => {
      context.fillText(word, x * scale, (row * pitch + (MARGIN + BASELINE) * height) * scale);
      x += widths[row][i] + space;
    });
  });
  return { canvas, size: [canvas.width / scale, canvas.height / scale] };
}

/** @param {any} object */
export function dressText(object) {
  const { material, userData } = object;
  if (!material.map) return;
  const size = { value: [0, 0] };
  const first = rawColors(material, "text", (shader) => {
    shader.uniforms.uSize = size;
    shader.vertexShader =
      "uniform vec2 uSize;\n" + shader.vertexShader.replace("#include <project_vertex>", FACE);
    shader.fragmentShader = shader.fragmentShader.replace(
      "#include <map_fragment>",
      "diffuseColor.a *= texture2D(map, vMapUv).a;",
    );
  });
  if (!first) return;
  const drawn = drawText(userData);
  size.value = drawn.size;
  // Its geometry is a point.
  object.frustumCulled = false;
  material.color.r = userData.color[0];
  material.color.g = userData.color[1];
  material.color.b = userData.color[2];
  material.opacity = userData.alpha;
  const { map } = material;
  map.image = drawn.canvas;
  Object.assign(map, { colorSpace: "", generateMipmaps: true, needsUpdate: true });
  Object.assign(map, { magFilter: LINEAR, minFilter: LINEAR_MIPMAPS });
}

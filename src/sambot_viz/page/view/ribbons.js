// @ts-check
/* Ribbons: lines with a width in metres. Each point of a line is there twice; the two go apart
 * across the line and across the direction to the eye, as Ogre's billboard chains do: the ends are
 * square, corners are cut.
 */

import { rawColors } from "./raw_colors.js";

const WIDEN = `
vec4 mvPosition = modelViewMatrix * vec4(transformed, 1.0);
vec3 sAlong = mat3(modelViewMatrix) * _aside.xyz;
vec3 sAcross = cross(sAlong, isOrthographic ? vec3(0.0, 0.0, 1.0) : -mvPosition.xyz);
float sSize = length(sAcross);
if (sSize > 0.0) mvPosition.xyz += sAcross * (_aside.w * 0.5 * uWidth / sSize);
gl_Position = projectionMatrix * mvPosition;
`;

/** @param {any} object */
export function dressRibbon(object) {
  const width = { value: object.userData.width };
  const first = rawColors(object.material, "ribbon", (shader) => {
    shader.uniforms.uWidth = width;
    shader.vertexShader =
      "attribute vec4 _aside;\nuniform float uWidth;\n" +
      shader.vertexShader.replace("#include <project_vertex>", WIDEN);
  });
  // The bounds of its geometry are those of a line without a width.
  if (first) object.frustumCulled = false;
}

// @ts-check
/* Colours of vertices on the screen as they were sent: they change evenly between two vertices
 * in the numbers of the screen, as RViz's do, and not in linear light.
 */

const CONVERSIONS = ["#include <tonemapping_fragment>", "#include <colorspace_fragment>"];
const known = new WeakSet();

/**
 * Take the conversion of colours out of an unlit material.
 * @param {any} material
 * @param {string} kind all materials of one kind have the same shader
 * @param {(shader: any) => void} change what else its shader has to have
 * @returns {boolean} whether the material is seen first
 */
export function rawColors(material, kind, change = () => {}) {
  if (known.has(material)) return false;
  known.add(material);
  material.onBeforeCompile = (/** @type {any} */ shader) => {
    for (const chunk of CONVERSIONS) {
      shader.fragmentShader = shader.fragmentShader.replace(chunk, "");
    }
    change(shader);
  };
  material.customProgramCacheKey = () => `sambot-${kind}`;
  material.needsUpdate = true;
  return true;
}

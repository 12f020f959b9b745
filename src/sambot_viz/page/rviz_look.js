/* Makes viser's three.js page draw as RViz draws (spec/rviz-core.md §8).
 *
 * RViz: no tone mapping, no gamma, no ambient light, one white light that looks
 * where the camera looks. A lit surface has the colour  material * max(0, n·v);
 * translucent shapes write no depth; names are white without a box.
 *
 * Everything is done by rewriting shaders where their text is as expected. What is
 * not recognised is left alone, so a changed viser gives a plainer picture, never
 * an empty page. `window.sambotVizLook` says what took effect and how many names are
 * laid out. A toon material is
 * our sign for "unlit" (RViz's white links without a transform).
 */
(() => {
  "use strict";
  if (window.sambotVizLook) return;
  const look = { lit: 0, unlit: 0, names: 0, boxes: 0, frames: 0, labels: 0 };
  window.sambotVizLook = look;

  const ENCODE = `
vec3 sambotEncode(vec3 c) {
  c = clamp(c, 0.0, 1.0);
  return mix(1.055 * pow(c, vec3(0.41666)) - 0.055, c * 12.92,
             vec3(lessThanEqual(c, vec3(0.0031308))));
}
`;
  const NO_CONVERSION = ["#include <tonemapping_fragment>", "#include <colorspace_fragment>"];

  const rewrite = (material, kind, shade) => {
    const anchor = "#include <opaque_fragment>";
    material.onBeforeCompile = (shader) => {
      let source = shader.fragmentShader;
      if (!source.includes(anchor) || !source.includes("void main() {")) return;
      source = source.replace("void main() {", ENCODE + "void main() {");
      source = source.replace(anchor, shade + "\n" + anchor);
      for (const chunk of NO_CONVERSION) source = source.replace(chunk, "");
      shader.fragmentShader = source;
      look[kind] += 1;
    };
    material.customProgramCacheKey = () => "sambot-" + kind;
    material.needsUpdate = true;
  };

  const boxes = new WeakSet();
  const adoptLabels = (material) => {
    const source = material.fragmentShader;
    if (source.includes("0.85 * vAlpha")) {
      material.fragmentShader = source.replace("0.85 * vAlpha", "0.0");
      boxes.add(material);
      look.boxes += 1;
    } else if (source.includes("gl_FragColor = vec4(0.0, 0.0, 0.0, a)")) {
      material.fragmentShader = source.replace("vec4(0.0, 0.0, 0.0, a)", "vec4(1.0, 1.0, 1.0, a)");
      look.names += 1;
    } else return;
    // RViz puts the baseline 0.75 em below the frame; viser's top anchor puts it
    // 1.02 em below (measured in tests/golden).
    const corner = "vec2 local = (aRect.xy + corner * aRect.zw) * scale;";
    material.vertexShader = material.vertexShader.replace(
      corner, corner + "\n  if (aParams.x < 0.5) local.y += 0.27 * 64.0 * scale;");
    material.needsUpdate = true;
  };

  const known = new WeakSet();
  const adopt = (material) => {
    if (!known.has(material)) {
      known.add(material);
      if (material.isMeshStandardMaterial) {
        rewrite(material, "lit",
          "outgoingLight = sambotEncode(totalEmissiveRadiance)" +
          " + sambotEncode(diffuseColor.rgb) * max(0.0, normal.z);");
      } else if (material.isMeshToonMaterial) {
        rewrite(material, "unlit", "outgoingLight = sambotEncode(diffuseColor.rgb);");
      } else if (material.isShaderMaterial) {
        adoptLabels(material);
      }
    }
    if (material.isMeshStandardMaterial) material.depthWrite = !material.transparent;
  };

  let labels = 0;
  const visit = (object) => {
    const material = object.material;
    if (material !== undefined) {
      if (Array.isArray(material)) material.forEach(adopt);
      else adopt(material);
      if (boxes.has(material)) labels += object.geometry.instanceCount;
    }
    for (const child of object.children) visit(child);
  };

  // RViz draws translucent things from far to near by the distance of their origins;
  // three.js goes by their depth along the view, which is another order.
  let eye = null;
  const distance = (object) => {
    const m = object.matrixWorld.elements, e = eye.elements;
    return (m[12] - e[12]) ** 2 + (m[13] - e[13]) ** 2 + (m[14] - e[14]) ** 2;
  };
  const farFirst = (a, b) => a.groupOrder - b.groupOrder || a.renderOrder - b.renderOrder
    || distance(b.object) - distance(a.object) || a.id - b.id;

  let hooked = null;
  const hook = () => {
    const mutable = window.__viserMutable;
    const scene = mutable && mutable.scene;
    if (!scene || scene === hooked) return;
    hooked = scene;
    scene.onBeforeRender = (renderer, _, camera) => {
      renderer.toneMapping = 0;
      eye = camera.matrixWorld;
      renderer.setTransparentSort(farFirst);
      labels = 0;
      visit(scene);
      look.labels = labels;
      look.frames += 1;
    };
    if (mutable.requestRender) mutable.requestRender();
  };
  // viser's notice about software rendering covers the picture, and says what cannot
  // be helped where this program is used: on machines without a GPU.
  const tidy = () => {
    for (const note of document.querySelectorAll(".mantine-Notification-root")) {
      if (note.textContent.startsWith("Software WebGL")) note.style.display = "none";
    }
  };

  // The page keeps its scene for its whole life, but it is made some frames after
  // this script may run, and again after a lost WebGL context.
  hook();
  setInterval(() => { hook(); tidy(); }, 100);

  // viser only reconnects a page that has the focus: a wall display never would.
  document.hasFocus = () => true;
  document.title = "sambot-viz";
})();

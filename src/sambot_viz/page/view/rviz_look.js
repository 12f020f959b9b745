// @ts-check
/* Makes viser's three.js page draw as RViz draws.
 *
 * RViz: no tone mapping, no gamma, no ambient light, one white light in the viewing
 * direction of the camera. A lit surface has the colour  material * max(0, n·v);
 * translucent shapes write no depth; names are white without a box; the background
 * fills the picture; an orthographic view shows all that is less than 500 m high.
 *
 * Shaders are rewritten only where their text is as expected. What is not recognised
 * is left alone, so a changed viser gives a plainer picture, never an empty page.
 * `window.sambotVizLook` counts what took effect, the pictures of the view and those
 * for cameras (scene_camera.js), and how many names are laid out. The
 * server sends a toon material for what is unlit (RViz's white links without a
 * transform).
 */

import { moveCamera } from "./camera.js";
import { others } from "./cameras.js";
import { dressDrawn } from "./drawn.js";
import { currentLook } from "./look.js";
import { drawTogether } from "./messages.js";
import { keepSharp } from "./sharp.js";
import { eye, farFirst, lookFrom, sortBatch } from "./sorting.js";
import { reportWindow } from "./window_size.js";
import { beginStudio, dress, finishStudio, STUDIO_LIT, studioUniform, TAG } from "./studio.js";

const look = {
  lit: 0,
  unlit: 0,
  studio: 0,
  waiting: 0,
  names: 0,
  boxes: 0,
  frames: 0,
  cameras: 0,
  labels: 0,
  backgrounds: 0,
  geometries: 0,
};
window.sambotVizLook = look;

const ENCODE = `
vec3 sambotEncode(vec3 c) {
  c = clamp(c, 0.0, 1.0);
  return mix(1.055 * pow(c, vec3(0.41666)) - 0.055, c * 12.92,
             vec3(lessThanEqual(c, vec3(0.0031308))));
}
`;
const NO_CONVERSION = ["#include <tonemapping_fragment>", "#include <colorspace_fragment>"];

/**
 * Give a material of three.js another last step of its shader.
 * @param {any} material
 * @param {"lit" | "unlit" | "studio"} kind
 * @param {string} shade GLSL that sets outgoingLight
 * @param {string} begin GLSL before the main function
 */
const rewrite = (material, kind, shade, begin = ENCODE) => {
  const anchor = "#include <opaque_fragment>";
  material.onBeforeCompile = (/** @type {any} */ shader) => {
    let source = shader.fragmentShader;
    if (!source.includes(anchor) || !source.includes("void main() {")) return;
    source = source.replace("void main() {", begin + "void main() {");
    source = source.replace(anchor, shade + "\n" + anchor);
    for (const chunk of NO_CONVERSION) source = source.replace(chunk, "");
    shader.fragmentShader = source;
    look[kind] += 1;
  };
  material.customProgramCacheKey = () => "sambot-" + kind;
  material.needsUpdate = true;
};

const ON_SCREEN = "varying float vOnScreen;\n";
const boxes = new WeakSet();
/** Make names white and hide their boxes. What has a size on the screen instead of in
 * the scene is no name of RViz: it keeps its box. @param {any} material */
const adoptLabels = (material) => {
  const source = material.fragmentShader;
  if (source.includes("0.85 * vAlpha")) {
    material.fragmentShader =
      ON_SCREEN +
      TAG.begin +
      source
        .replace("0.85 * vAlpha", "0.85 * vAlpha * vOnScreen")
        .replace(/\}\s*$/, `${TAG.color}}`);
    material.vertexShader = TAG.begin + material.vertexShader;
    material.uniforms = { ...material.uniforms, uStudio: studioUniform };
    boxes.add(material);
    look.boxes += 1;
  } else if (source.includes("gl_FragColor = vec4(0.0, 0.0, 0.0, a)")) {
    material.fragmentShader =
      ON_SCREEN + source.replace("vec4(0.0, 0.0, 0.0, a)", "vec4(vec3(1.0 - vOnScreen), a)");
    look.names += 1;
  } else return;
  // RViz puts the baseline 0.75 em below the frame; viser's top anchor puts it
  // 1.02 em below (measured in tests/golden).
  const corner = "vec2 local = (aRect.xy + corner * aRect.zw) * scale;";
  material.vertexShader =
    ON_SCREEN +
    material.vertexShader.replace(
      corner,
      corner +
        "\n  vOnScreen = aParams.x;\n  if (aParams.x < 0.5) local.y += 0.27 * 64.0 * scale;" +
        (boxes.has(material) ? TAG.place : ""),
    );
  material.needsUpdate = true;
};

/** The objects that viser draws the background and the boxes of names on. @type {any} */
let background = null;
/** @type {any} */
let tags = null;

/**
 * Let the background fill the picture whatever the camera. viser draws it on a
 * plane 1 m in front of the camera, which a near plane beyond 1 m cuts away.
 * @param {any} object
 */
const adoptBackground = (object) => {
  const material = object.material;
  const anchor = "gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);";
  if (!material.vertexShader.includes(anchor)) return;
  material.vertexShader = material.vertexShader.replace(
    anchor,
    "gl_Position = vec4(2.0 * position.xy, 0.5, 1.0);",
  );
  background = object;
  material.needsUpdate = true;
  object.frustumCulled = false;
  object.renderOrder = -2000;
  look.backgrounds += 1;
};

/** Which look lit materials have. @type {WeakMap<object, string>} */
const lit = new WeakMap();
/** Light a shape. @param {any} material */
const light = (material) => {
  const now = currentLook();
  if (lit.get(material) === now) return;
  lit.set(material, now);
  if (now === "studio") rewrite(material, "studio", STUDIO_LIT.shade, STUDIO_LIT.begin);
  else {
    rewrite(
      material,
      "lit",
      "outgoingLight = sambotEncode(totalEmissiveRadiance)" +
        " + sambotEncode(diffuseColor.rgb) * max(0.0, normal.z);" +
        // What is seen from both sides is lit on one.
        "\n#ifdef DOUBLE_SIDED\nif (!gl_FrontFacing) outgoingLight = vec3(0.0);\n#endif",
    );
  }
};

const known = new WeakSet();
/** Change a material when it is seen first. @param {any} material @param {any} object */
const adopt = (material, object) => {
  if (material.isMeshStandardMaterial) light(material);
  else if (!known.has(material)) {
    known.add(material);
    if (material.isMeshToonMaterial) {
      rewrite(material, "unlit", "outgoingLight = sambotEncode(diffuseColor.rgb);");
    } else if (material === window.__viserMutable?.backgroundMaterial) {
      adoptBackground(object);
    } else if (material.isShaderMaterial) {
      adoptLabels(material);
    }
  }
  if (material.isMeshStandardMaterial) material.depthWrite = !material.transparent;
};

/** Shade a mesh by the normals of its file where viser has put those of its faces.
 * @param {any} geometry */
function takeNormals(geometry) {
  const own = geometry?.attributes?._normal;
  if (!own) return;
  geometry.setAttribute("normal", own);
  geometry.deleteAttribute("_normal");
}

let labels = 0;
/**
 * Look at an object and all below it.
 * @param {any} object
 * @param {boolean} studio
 * @param {boolean} shown whether all above it are visible
 */
const visit = (object, studio, shown) => {
  // When viser makes a batch of meshes again, as it does when it gets another material, the old
  // one is in the scene for some pictures more, disposed of: WebGL would refuse to draw it.
  if (object.isInstancedMesh2 && !object.instanceIndex) object.visible = false;
  sortBatch(object);
  takeNormals(object.geometry);
  dressDrawn(object, eye);
  const visible = shown && object.visible;
  const material = object.material;
  if (material !== undefined) {
    if (Array.isArray(material)) for (const one of material) adopt(one, object);
    else adopt(material, object);
    if (boxes.has(material)) {
      labels += object.geometry.instanceCount;
      if (material.depthTest) tags = object;
    }
    dress(studio, object, visible);
  }
  for (const child of object.children) visit(child, studio, visible);
};

// viser has no orthographic camera: the server sends a far one with a field of view
// below 1 degree, and the mouse zooms by moving it. The near plane must follow, or it
// cuts everything away; it cannot stay at the camera, as depth would lose all digits.
const HIGHEST = 500;
/** @param {any} camera */
const followZoom = (camera) => {
  const { camera: main, cameraControl } = window.__viserMutable || {};
  if (camera !== main || !cameraControl || !(camera.fov < 1)) return;
  const away = cameraControl.distance;
  const near = Math.max(0.01, away - HIGHEST);
  const far = Math.max(100000, 2 * away);
  if (camera.near === near && camera.far === far) return;
  camera.near = near;
  camera.far = far;
  camera.updateProjectionMatrix();
};

/** @type {any} */
let hooked = null;
const hook = () => {
  const mutable = window.__viserMutable;
  const scene = mutable && mutable.scene;
  keepSharp(mutable);
  reportWindow(mutable);
  if (!scene || scene === hooked) return;
  hooked = scene;
  scene.onBeforeRender = (
    /** @type {any} */ renderer,
    /** @type {any} */ _,
    /** @type {any} */ camera,
  ) => {
    renderer.toneMapping = 0;
    others.draw(renderer, scene, camera, [background], tags?.parent);
    followZoom(camera);
    lookFrom(camera.matrixWorld);
    renderer.setTransparentSort(farFirst);
    labels = 0;
    const studio = currentLook() === "studio";
    beginStudio(studio);
    visit(scene, studio, true);
    if (others.has(camera)) {
      look.cameras += 1;
      return;
    }
    look.labels = labels;
    look.waiting = finishStudio(studio, scene, camera, background, tags);
    if (look.waiting) mutable.requestRender?.();
    look.geometries = renderer.info.memory.geometries;
    look.frames += 1;
  };
  drawTogether(scene);
  const store = scene.__r3f?.root;
  store?.getState().internal.subscribe({ current: () => prepare(scene) }, PRIORITY, store);
  if (mutable.requestRender) mutable.requestRender();
};

/** Behind viser's poses of nodes (-1000), before its pictures for others (-500), its controls (-1) and
 * its names (0). */
const PRIORITY = -900;
/** Called before each picture, when viser has placed the nodes in it. @param {any} scene */
const prepare = (scene) => {
  moveCamera();
  // viser writes its names to where their frames were when the scene was drawn last.
  if (look.labels) scene.updateMatrixWorld();
};

// viser's notice about software rendering covers the picture, and a machine without a
// GPU, where this program is often used, cannot change it. What was downloaded is said
// by the browser and in the status bar.
const tidy = () => {
  /** @type {NodeListOf<HTMLElement>} */
  const notes = document.querySelectorAll(".mantine-Notification-root");
  for (const note of notes) {
    if (/^(Software WebGL|Receiv)/.test(note.textContent || "")) note.style.display = "none";
  }
  // Below a path of a proxy, the address of the server stands behind the page's, from
  // viser_address.js and from viser. It goes when viser, which unpacks itself first, has read it.
  const query = new URLSearchParams(location.search);
  if (!window.__viserMutable || !query.has("websocket")) return;
  query.delete("websocket");
  history.replaceState(null, "", query.size ? `?${query}` : location.pathname);
};

// The page keeps its scene for its whole life, but it is made some frames after
// this script may run, and again after a lost WebGL context.
hook();
setInterval(() => {
  hook();
  tidy();
}, 100);

// viser only reconnects a page that has the focus: a wall display never would.
document.hasFocus = () => true;
document.title = "sambot-viz";

// @ts-check
/* The look "Studio": round shapes (studio_shapes.js), a shadow where the robot stands
 * (studio_shadow.js), names beside each other (studio_names.js), and soft light from above, a fill
 * from the other side, a rim, and a shoulder in place of blown-out whites. The lights are at the
 * camera and above, so that a robot is well lit from wherever it is seen. The light is in the
 * shaders of the shapes themselves: no light of three.js, no shadow map.
 */

import { moveNames } from "./studio_names.js";
import { beginShapes, putBack, roundOff, waitingShapes } from "./studio_shapes.js";
import { drawShadow, dropShadow } from "./studio_shadow.js";

/** Linear light to what a screen shows; what is brighter than white bends to it. The curve of sRGB by
 * square roots is within 2 of 255, and takes a third of the time of its power without a GPU. */
const SHOULDER = `
vec3 sambotShown(vec3 c) {
  vec3 over = max(vec3(0.0), c - 0.7);
  c = min(c, 0.7) + 0.3 * over / (0.3 + over);
  vec3 s1 = sqrt(c);
  vec3 s2 = sqrt(s1);
  return 0.662002687 * s1 + 0.684122060 * s2 - 0.323583601 * sqrt(s2) - 0.0225411470 * c;
}
`;
const LIT = `
vec3 sN = normal;
vec3 sV = isOrthographic ? vec3(0.0, 0.0, 1.0) : normalize(vViewPosition);
vec3 sUp = viewMatrix[1].xyz;
vec3 sKey = normalize(vec3(-0.55, 0.25, 0.55) + 0.75 * sUp);
const vec3 sFill = vec3(0.8826, 0.0519, 0.4673);
float sSky = 0.5 + 0.5 * dot(sN, sUp);
float sFacing = max(0.0, dot(sN, sV));
vec3 sLight = mix(vec3(0.15, 0.145, 0.14), vec3(0.36, 0.39, 0.43), sSky);
sLight += vec3(0.80, 0.77, 0.72) * max(0.0, (dot(sN, sKey) + 0.15) / 1.15);
sLight += vec3(0.13, 0.15, 0.18) * max(0.0, dot(sN, sFill));
float sShine = max(0.0, dot(sN, normalize(sKey + sV)));
sShine *= sShine;
sShine *= sShine;
sShine *= sShine;
float sGlint = sShine * sShine;
sGlint *= sGlint;
float sRim = (1.0 - sFacing) * (1.0 - sFacing) * (1.0 - sFacing) * (0.25 + 0.75 * sSky);
vec3 sGloss = vec3(0.09 * sGlint + 0.03 * sShine) + vec3(0.10, 0.11, 0.13) * sRim;
outgoingLight = sambotShown(totalEmissiveRadiance + diffuseColor.rgb * sLight + sGloss);
`;
/** The material of a lit shape: what its shader is to have, as rviz_look.js rewrites it. */
export const STUDIO_LIT = { begin: SHOULDER, shade: LIT };

/** 1 in Studio, 0 in RViz's look: the shaders of what both draw read it. */
export const studioUniform = { value: 0 };

/** Behind a name is a dark tag with round ends. */
export const TAG = {
  begin: "uniform float uStudio;\nvarying vec2 vTag;\nvarying vec2 vTagSize;\n",
  place: "\n  vTag = (corner - 0.5) * aRect.zw;\n  vTagSize = aRect.zw;",
  color: `
  if (uStudio > 0.5 && vOnScreen < 0.5) {
    vec2 sHalf = 0.5 * vTagSize - vec2(0.0, 6.0);
    float sRound = 0.6 * sHalf.y;
    float sOut = length(max(abs(vTag) - sHalf + sRound, 0.0)) - sRound;
    gl_FragColor = vec4(0.05, 0.06, 0.07, 0.5 * vAlpha * (1.0 - smoothstep(-3.0, 1.0, sOut)));
  }
`,
};

/** How far the camera is from what it looks at [m]. */
const focus = { value: 1 };
/** Which line materials have our shader. @type {WeakMap<object, {transparent: boolean}>} */
const faded = new WeakMap();
/** Let the lines of a grid fade to its rim and to the horizon. @param {any} object */
function fade(object) {
  const { material, geometry } = object;
  if (faded.has(material)) return;
  faded.set(material, { transparent: material.transparent });
  if (!geometry.boundingSphere) geometry.computeBoundingSphere();
  // A grid is a square: its corners are farther out than its sides.
  const rim = Math.max(1e-3, geometry.boundingSphere.radius * Math.SQRT1_2).toExponential(4);
  material.onBeforeCompile = (/** @type {any} */ shader) => {
    shader.uniforms.uFocus = focus;
    shader.vertexShader = `varying vec2 vFar;\n${shader.vertexShader}`.replace(
      "#include <project_vertex>",
      "#include <project_vertex>\n  vFar = vec2(length(position.xz), length(mvPosition.xyz));",
    );
    shader.fragmentShader =
      `varying vec2 vFar;\nuniform float uFocus;\n${shader.fragmentShader}`.replace(
        "#include <opaque_fragment>",
        `diffuseColor.a *= (1.0 - smoothstep(0.6, 1.0, vFar.x / float(${rim})))
        * (1.0 - smoothstep(1.6, 7.0, vFar.y / uFocus));
      #include <opaque_fragment>`,
      );
  };
  material.customProgramCacheKey = () => `sambot-fade-${rim}`;
  material.transparent = true;
  material.needsUpdate = true;
}

/** @param {any} object */
function unfade({ material }) {
  const had = faded.get(material);
  if (!had) return;
  faded.delete(material);
  // Those of its class are there again.
  delete material.onBeforeCompile;
  delete material.customProgramCacheKey;
  material.transparent = had.transparent;
  material.needsUpdate = true;
}

/** Whether the picture before was drawn in Studio. */
let was = false;
/** The lit shapes that are seen in this picture. @type {any[]} */
let seen = [];

/** Begin a picture; `dress` is called for its objects then. @param {boolean} studio */
export function beginStudio(studio) {
  seen = [];
  if (!studio && !was) return;
  studioUniform.value = studio ? 1 : 0;
  focus.value = Math.max(0.5, window.__viserMutable?.cameraControl?.distance || 1);
  beginShapes();
}

/**
 * Give an object the look of the picture.
 * @param {boolean} studio
 * @param {any} object
 * @param {boolean} visible whether it is shown, and all above it
 */
export function dress(studio, object, visible) {
  // Back in RViz's look, what is hidden has to be as it was, too.
  if (studio ? !visible : !was) return;
  const { material } = object;
  if (material?.isMeshStandardMaterial && object.isMesh) {
    if (studio) roundOff(object);
    else putBack(object);
    if (!object.isInstancedMesh && material.opacity > 0.05) seen.push(object);
  } else if (material?.isLineBasicMaterial && object.isLineSegments && !object.userData.drawAs) {
    if (studio) fade(object);
    else unfade(object);
  }
}

/**
 * End the preparation of a picture, behind all its objects.
 * @param {boolean} studio
 * @param {any} scene
 * @param {any} camera
 * @param {any} background the object that viser draws the background on
 * @param {any} names the boxes behind all names
 * @returns {number} how many meshes, and the shadow, are not as they will be
 */
export function finishStudio(studio, scene, camera, background, names) {
  if (!studio && !was) return 0;
  was = studio;
  if (names) moveNames(names, camera, studio);
  let late = 0;
  if (studio && background) late = Number(drawShadow(scene, background, seen));
  else dropShadow();
  return waitingShapes() + late;
}

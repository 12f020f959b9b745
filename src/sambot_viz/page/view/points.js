// @ts-check
/* Points in the six styles of RViz. Each is a copy of one shape, which the graphics card places at
 * the points: dots, squares and discs that face the eye with the y axis of their cloud upwards,
 * boxes with sides of fixed brightness, and tiles in a plane. Nothing of it is lit.
 */

/** @typedef {{shape: string, size: number[], alpha: number, twice: boolean, byDepth: boolean,
 *   normal: number[], up: number[], color?: number[]}} Style */

const VERTEX = `
#include <common>
#include <logdepthbuf_pars_vertex>
attribute vec3 center;
attribute vec4 tint;
uniform vec3 uSize;
uniform vec4 uTint;
uniform vec2 uPixel;
uniform vec3 uNormal;
uniform vec3 uUp;
varying vec4 vTint;
varying vec2 vAt;
varying float vShade;
void main() {
  vTint = TINT;
  vAt = uv;
  vShade = 1.0;
#ifdef DOTS
  gl_Position = projectionMatrix * (modelViewMatrix * vec4(center, 1.0));
  gl_Position.xy += position.xy * uSize.x * uPixel * gl_Position.w;
#else
  vec3 corner = position * uSize;
#ifdef BY_DEPTH
  corner *= center.z;
#endif
#ifdef BOXES
  vShade = normal.z > 0.5 ? 0.9 : normal.z < -0.5 ? 0.5 : normal.y > 0.5 ? 0.4
    : normal.y < -0.5 ? 1.0 : 0.6;
#else
#ifdef TILES
  vec3 towards = uNormal, up = uUp;
#else
  vec3 eye = (inverse(modelViewMatrix) * vec4(0.0, 0.0, 0.0, 1.0)).xyz;
  vec3 towards = eye - center, up = vec3(0.0, 1.0, 0.0);
#endif
  vec3 right = cross(up, towards);
  right = dot(right, right) > 0.0 ? normalize(right) : vec3(1.0, 0.0, 0.0);
  corner = right * corner.x + normalize(cross(towards, right)) * corner.y;
#endif
  // Where two are in one plane the later one is in front, as in RViz, and not the one that was
  // rounded up: each is a little nearer than the one before, by less than 0.1 mm in a metre.
  vec4 seen = modelViewMatrix * vec4(center + corner, 1.0);
  seen.xyz *= 1.0 - 1e-6 * float(gl_InstanceID % 64);
  gl_Position = projectionMatrix * seen;
#endif
  #include <logdepthbuf_vertex>
}
`;

const FRAGMENT = `
#include <common>
#include <logdepthbuf_pars_fragment>
uniform float uAlpha;
uniform bool uTwice;
varying vec4 vTint;
varying vec2 vAt;
varying float vShade;
void main() {
  #include <logdepthbuf_fragment>
  vec3 color = vTint.rgb;
  float alpha = vTint.a * uAlpha;
  if (uTwice) alpha = 1.0 - (1.0 - alpha) * (1.0 - alpha);
#if defined(DOTS) || defined(DISCS)
  float rho = 4.0 * dot(vAt, vAt);
  if (rho > 1.0) discard;
#endif
#ifdef DISCS
  color *= 1.0 - 0.2 * rho;
#endif
#ifdef RIM
  vec2 far = (abs(vAt) - 0.45) / 0.03;
  float rim = clamp(max(far.x, far.y), 0.0, 1.0);
#ifdef BOXES
  color *= vShade * (1.0 - 0.5 * rim);
#else
  color = mix(color, color + (length(color) < 0.5 ? 0.2 : -0.2), rim);
#endif
#endif
  if (alpha < 0.002) discard;
  gl_FragColor = vec4(clamp(color, 0.0, 1.0), alpha);
}
`;

/** @type {Record<string, string[]>} */
const DEFINES = {
  Points: ["DOTS"],
  Squares: ["RIM"],
  "Flat Squares": [],
  Spheres: ["DISCS"],
  Boxes: ["BOXES", "RIM"],
  Tiles: ["TILES", "RIM"],
};
const SQUARE = [
  [-0.5, -0.5],
  [0.5, -0.5],
  [0.5, 0.5],
  [-0.5, 0.5],
];
const FLOATS = 3;

/** A square, or the six of a box: places, normals, places in the square, and triangles.
 * @param {boolean} box */
function shapeOf(box) {
  /** @type {{position: number[], normal: number[], uv: number[], index: number[]}} */
  const shape = { position: [], normal: [], uv: [], index: [] };
  const sides = box ? [0, 1, 2].flatMap((axis) => [1, -1].map((sign) => ({ axis, sign }))) : [null];
  for (const [n, side] of sides.entries()) {
    for (const [x = 0, y = 0] of SQUARE) {
      const at = [x, y, 0],
        normal = [0, 0, 1];
      if (side) {
        const { axis, sign } = side;
        for (let i = 0; i < FLOATS; i++) normal[i] = i === axis ? sign : 0;
        at[axis] = sign / 2;
        at[(axis + 1) % FLOATS] = sign * x;
        at[(axis + 2) % FLOATS] = y;
      }
      shape.position.push(...at);
      shape.normal.push(...normal);
      shape.uv.push(x, y);
    }
    shape.index.push(...[0, 1, 2, 0, 2, 3].map((corner) => 4 * n + corner));
  }
  return shape;
}

/** @param {any} attribute one for each point instead of one for each corner */
function instanced(attribute) {
  return Object.assign(attribute, { isInstancedBufferAttribute: true, meshPerAttribute: 1 });
}

/** Make copies of a shape out of the points of a file. @param {any} object */
export function dressPoints(object) {
  if (!object.isPoints) return;
  /** @type {Style} */
  const style = object.userData;
  const { position, color } = object.geometry.attributes;
  const geometry = new object.geometry.constructor();
  const Attribute = position.constructor;
  const shape = shapeOf(style.shape === "Boxes");
  for (const [name, size] of /** @type {const} */ ([
    ["position", 3],
    ["normal", 3],
    ["uv", 2],
  ]))
    geometry.setAttribute(name, new Attribute(new Float32Array(shape[name]), size));
  geometry.setIndex(new Attribute(new Uint16Array(shape.index), 1));
  geometry.setAttribute("center", instanced(position));
  if (color) geometry.setAttribute("tint", instanced(color));
  Object.assign(geometry, { isInstancedBufferGeometry: true, instanceCount: position.count });
  const pixel = { value: { x: 0, y: 0 } };
  const { material } = object;
  const defines = [...(DEFINES[style.shape] || []), `TINT ${color ? "tint" : "uTint"}`];
  if (style.byDepth) defines.push("BY_DEPTH");
  const head = defines.map((one) => `#define ${one}\n`).join("");
  material.onBeforeCompile = (/** @type {any} */ shader) => {
    shader.vertexShader = head + VERTEX;
    shader.fragmentShader = head + FRAGMENT;
    Object.assign(shader.uniforms, {
      uSize: { value: style.size },
      uTint: { value: (style.color || [255, 255, 255, 255]).map((channel) => channel / 255) },
      uAlpha: { value: style.alpha },
      uTwice: { value: style.twice },
      uNormal: { value: style.normal },
      uUp: { value: style.up },
      uPixel: pixel,
    });
  };
  material.customProgramCacheKey = () => `sambot-points ${head}`;
  // Squares have no back: they turn to the eye. That of a box is not seen through its front.
  material.side = style.shape === "Boxes" ? 0 : 2;
  material.needsUpdate = true;
  Object.assign(object, { geometry, isPoints: false, isMesh: true, frustumCulled: false });
  object.raycast = () => {};
  object.onBeforeRender = (/** @type {any} */ renderer) => {
    const ratio = 2 * renderer.getPixelRatio();
    renderer.getCurrentViewport({
      copy: (/** @type {any} */ { z, w }) => {
        pixel.value = { x: ratio / z, y: ratio / w };
      },
    });
  };
}

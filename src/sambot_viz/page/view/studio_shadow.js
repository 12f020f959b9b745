// @ts-check
/* Studio: the soft shadow where the robot stands. The outlines of its shapes, seen from above, are
 * drawn into a small picture, the lower the darker and sharper, and the picture lies on the
 * ground. It is drawn again only when something has moved: a camera that turns costs nothing. */

/** Side of the picture [pixels]. */
const SIDE = 128;
/** Shapes up to so high above the ground (of the side), how dark and how blurred their shadow is. */
const LAYERS = [
  { high: 0.03, dark: 0.62, blur: 0.035 },
  { high: 0.18, dark: 0.4, blur: 0.09 },
  { high: Infinity, dark: 0.26, blur: 0.17 },
];
/** How many corners of a mesh stand for all. */
const CORNERS = 64;
const VERTEX = `
varying vec2 vPlace;
void main() {
  vPlace = uv;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;
const FRAGMENT = `
uniform sampler2D uShadow;
varying vec2 vPlace;
void main() {
  gl_FragColor = vec4(0.0, 0.0, 0.0, 0.85 * texture2D(uShadow, vPlace).a);
}`;

/** While something moves, the shadow takes at most this part of the time: where it is slow, it
 * follows in steps. */
const SHARE = 0.12;
/** @typedef {{x: number, z: number}} Point on the ground; y is up */
/** The outermost corners of a geometry. @type {WeakMap<object, Float32Array>} */
const outer = new WeakMap();

/** @param {any} geometry */
function corners(geometry) {
  const known = outer.get(geometry);
  if (known) return known;
  const { position } = geometry.attributes;
  const step = Math.max(1, Math.floor(position.count / 20000));
  const chosen = new Set();
  for (let i = 0; i < CORNERS; i += 1) {
    // Directions that are spread evenly over a sphere.
    const y = 1 - (2 * i + 1) / CORNERS;
    const r = Math.sqrt(1 - y * y);
    const [x, z] = [r * Math.cos(2.4 * i), r * Math.sin(2.4 * i)];
    let [most, best] = [-Infinity, 0];
    for (let k = 0; k < position.count; k += step) {
      const far = x * position.getX(k) + y * position.getY(k) + z * position.getZ(k);
      if (far > most) [most, best] = [far, k];
    }
    chosen.add(best);
  }
  const found = new Float32Array(3 * chosen.size);
  [...chosen].forEach((k, i) =>
    found.set([position.getX(k), position.getY(k), position.getZ(k)], 3 * i),
  );
  outer.set(geometry, found);
  return found;
}

/** @param {any} object @returns {{points: Point[], low: number}} */
function outline(object) {
  const from = corners(object.geometry);
  const m = object.matrixWorld.elements;
  /** @type {Point[]} */
  const points = [];
  let low = Infinity;
  for (let i = 0; i < from.length; i += 3) {
    const [x, y, z] = from.subarray(i, i + 3);
    low = Math.min(low, m[1] * x + m[5] * y + m[9] * z + m[13]);
    points.push({
      x: m[0] * x + m[4] * y + m[8] * z + m[12],
      z: m[2] * x + m[6] * y + m[10] * z + m[14],
    });
  }
  return { points: hull(points), low };
}

/** The convex hull, in the same sense of rotation for all. @param {Point[]} points */
function hull(points) {
  points.sort((a, b) => a.x - b.x || a.z - b.z);
  /** @param {Point[]} from */
  const half = (from) => {
    /** @type {Point[]} */
    const kept = [];
    for (const p of from) {
      for (let n = kept.length; n > 1; n -= 1) {
        const [a, b] = [kept[n - 2], kept[n - 1]];
        if ((b.x - a.x) * (p.z - a.z) - (b.z - a.z) * (p.x - a.x) > 0) break;
        kept.pop();
      }
      kept.push(p);
    }
    return kept.slice(0, -1);
  };
  return [...half(points), ...half([...points].reverse())];
}

/** A number that changes when an object moves. @param {any[]} objects */
function state(objects) {
  let sum = objects.length;
  for (const { geometry, matrixWorld, material } of objects) {
    sum = sum * 1.0000001 + geometry.id + 3 * material.opacity;
    const e = matrixWorld.elements;
    for (let i = 0; i < 15; i += 1) sum += e[i] * (i + 1.37);
  }
  return sum;
}

/** @type {{mesh: any, canvas: HTMLCanvasElement, texture: any, state: number} | null} */
let shadow = null;
/** It is not drawn again before this time [ms]. */
let due = 0;

/** @param {any} background the object that viser draws the background on */
function make(background) {
  const { material, geometry } = background;
  const picture = material.uniforms.colorMap?.value;
  if (!picture || !geometry) return null;
  // Classes of three.js that no name leads to: those of what viser has made.
  let Texture = picture.constructor;
  if (picture.isDataTexture || picture.isCanvasTexture) Texture = Object.getPrototypeOf(Texture);
  const canvas = document.createElement("canvas");
  canvas.width = SIDE;
  canvas.height = SIDE;
  const texture = new Texture(canvas);
  texture.generateMipmaps = false;
  texture.minFilter = picture.magFilter;
  const made = new material.constructor({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    uniforms: { uShadow: { value: texture } },
    transparent: true,
    depthWrite: false,
  });
  const mesh = new background.constructor(geometry.clone(), made);
  mesh.rotation.x = -Math.PI / 2;
  mesh.renderOrder = -1;
  mesh.raycast = () => undefined;
  mesh.name = "sambot-shadow";
  return { mesh, canvas, texture, state: NaN };
}

/**
 * Draw the shadow of what is shown.
 * @param {any} scene
 * @param {any} background see `make`
 * @param {any[]} objects the lit shapes that are seen
 * @returns {boolean} whether it is still that of an earlier moment
 */
export function drawShadow(scene, background, objects) {
  shadow ??= make(background);
  if (!shadow) return false;
  if (shadow.mesh.parent !== scene) scene.add(shadow.mesh);
  shadow.mesh.visible = objects.length > 0;
  const now = state(objects);
  if (!objects.length || now === shadow.state) return false;
  const begin = performance.now();
  if (begin < due) return true;
  shadow.state = now;
  const outlines = objects.map(outline);
  const all = outlines.flatMap(({ points }) => points);
  const xs = all.map(({ x }) => x);
  const zs = all.map(({ z }) => z);
  const ground = Math.min(...outlines.map(({ low }) => low));
  const [left, back] = [Math.min(...xs), Math.min(...zs)];
  const wide = Math.max(Math.max(...xs) - left, Math.max(...zs) - back, 1e-3);
  const side = 1.5 * wide;
  const middle = { x: (left + Math.max(...xs)) / 2, z: (back + Math.max(...zs)) / 2 };
  paint(shadow.canvas, outlines, ground, side, middle);
  shadow.texture.needsUpdate = true;
  shadow.mesh.position.set(middle.x, ground - 0.001 * wide, middle.z);
  shadow.mesh.scale.set(side, side, 1);
  shadow.mesh.updateMatrixWorld();
  const end = performance.now();
  due = end + (end - begin) / SHARE;
  return false;
}

/**
 * @param {HTMLCanvasElement} canvas
 * @param {{points: Point[], low: number}[]} outlines
 * @param {number} ground where it is [m]
 * @param {number} side of the picture [m]
 * @param {Point} middle of the picture
 */
function paint(canvas, outlines, ground, side, middle) {
  const context = canvas.getContext("2d");
  if (!context) return;
  context.clearRect(0, 0, SIDE, SIDE);
  const pixel = SIDE / side;
  let from = -Infinity;
  for (const { high, dark, blur } of LAYERS) {
    context.shadowColor = `rgb(0 0 0 / ${dark})`;
    context.shadowBlur = 2 * blur * SIDE * 0.6;
    // Only what is blurred is seen: the shapes themselves are beside the picture.
    context.shadowOffsetX = 2 * SIDE;
    context.beginPath();
    for (const { points, low } of outlines) {
      const height = (low - ground) / side;
      if (height <= from || height > high) continue;
      points.forEach(({ x, z }, i) => {
        const at = [(x - middle.x) * pixel - 1.5 * SIDE, (z - middle.z) * pixel + SIDE / 2];
        if (i) context.lineTo(at[0], at[1]);
        else context.moveTo(at[0], at[1]);
      });
      context.closePath();
    }
    context.fill();
    from = high;
  }
}

/** Take the shadow away. */
export function dropShadow() {
  if (!shadow) return;
  shadow.mesh.removeFromParent();
}

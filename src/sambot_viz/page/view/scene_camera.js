// @ts-check
/* The scene in the pictures of a camera: it is drawn once more from the pose of the camera, with
 * its focal lengths, behind or below the image. That is done at the beginning of a picture of the
 * view, in the corner of its canvas, and copied from there before the view itself is drawn: so it
 * costs one more drawing of the scene, and only when something has changed. */

import { others } from "./cameras.js";
import { followMessages } from "./messages.js";

/**
 * How a camera sees the scene; lengths in the image are in its pixels.
 * @typedef {{position: number[], wxyz: number[], focus: number[], center: number[], size: number[],
 *   roi: number[], zoom: number, far: number, behind: boolean, over: number, hidden: string[]}} View
 */

const NEAR = 0.01;
/** So often the scene is drawn at most [ms]. */
const PERIOD = 66;
/** So long after a message what it has brought may still come into the scene [ms] … */
const SETTLES = 500;
/** … and in so many pictures of the view in any case: one may take a second on a slow page. */
const PICTURES = 3;
/** More pixels than these in a CSS pixel nobody sees. */
const MOST = 2;
/** The part of a node's name that says which display has drawn it; a tool has no number. */
const OWNER = /\/(~(?:[0-9a-z]+_)?)/;
const TOOL = "~";

/**
 * What of the scene is seen in a window, and where in it the image is.
 * @param {View} view @param {number} width @param {number} height of the window [pixels]
 * @returns {{sides: number[], image: number[]} | null} sides: left, right, top and bottom of what is
 *   seen at the near plane [m]; image: left, top, width and height [pixels]; null for no window
 */
export function framing({ focus, center, size, roi, zoom }, width, height) {
  const [fx, fy] = focus,
    [w, h] = size;
  const wide = w / fx / (h / fy),
    room = width / height;
  const zx = zoom * (wide > room ? 1 : wide / room);
  const zy = zoom * (wide > room ? room / wide : 1);
  // Half of what is seen at the near plane, and where the axis of the camera is in it.
  const x = (NEAR * w) / (2 * fx * zx),
    y = (NEAR * h) / (2 * fy * zy);
  const aside = 2 * (0.5 - center[0] / w) * zx,
    above = 2 * (center[1] / h - 0.5) * zy;
  const sides = [x * (aside - 1), x * (aside + 1), y * (above + 1), y * (above - 1)];
  const part = roi[2] || roi[3] ? roi : [0, 0, w, h];
  const [left, top, across, down] = [part[0] / w, part[1] / h, part[2] / w, part[3] / h];
  const image = [
    ((1 + (2 * left - 1) * zx) * width) / 2,
    ((1 - (1 - 2 * top) * zy) * height) / 2,
    across * zx * width,
    down * zy * height,
  ];
  return [...sides, ...image].every(Number.isFinite) ? { sides, image } : null;
}

/** The cameras whose pictures are on the screen. @type {Set<SceneCamera>} */
const open = new Set();
/** For how long the scene may change after a message. */
export class Settling {
  until = 0;
  pictures = 0;

  /** A message came. @param {number} now [ms] */
  note(now) {
    this.until = now + SETTLES;
    this.pictures = PICTURES;
  }

  /** Whether the next picture may show something else. @param {number} now [ms] */
  picture(now) {
    this.pictures -= 1;
    return now < this.until || this.pictures >= 0;
  }
}
const settling = new Settling();
followMessages(() => settling.note(performance.now()));

/** The picture of a camera, on a canvas: the image alone, or with the scene. */
export class SceneCamera {
  /** @param {Element} room has a canvas, which fills it */
  constructor(room) {
    this.room = room;
    this.canvas = /** @type {HTMLCanvasElement} */ (room.querySelector("canvas"));
    this.image = document.createElement("canvas");
    /** @type {View | null} */
    this.view = null;
    this.isNew = false;
    this.drawn = -Infinity;
    this.timer = 0;
    this.resized = new ResizeObserver(() => this.draw());
  }

  /** Show an image, with the scene where there is a view. @param {ImageBitmap | null} image
   * @param {View | null} [view] */
  show(image, view = null) {
    this.image.width = image?.width || 1;
    this.image.height = image?.height || 1;
    if (image) this.image.getContext("2d")?.drawImage(image, 0, 0);
    this.view = image ? view : null;
    this.draw();
  }

  /** Follow changes of the scene, or do not: nobody sees it. @param {boolean} seen */
  follow(seen) {
    if (seen) {
      open.add(this);
      this.resized.observe(this.room);
      this.draw();
    } else this.close();
  }

  close() {
    open.delete(this);
    clearTimeout(this.timer);
    this.resized.disconnect();
  }

  /** Draw the image, and the scene with the next picture of the view. */
  draw() {
    const { canvas, image, view } = this;
    if (!view) {
      this.drawn = -Infinity;
      canvas.width = image.width;
      canvas.height = image.height;
      canvas.getContext("2d")?.drawImage(image, 0, 0);
      return;
    }
    this.isNew = true;
    if (this.drawn < 0) compose(this, null);
    this.ask();
  }

  /** Have the view drawn, and the picture with it, when it may be. */
  ask() {
    clearTimeout(this.timer);
    const { scene } = window.__viserMutable || {};
    const rest = this.drawn + PERIOD - performance.now();
    if (rest > 0) this.timer = window.setTimeout(() => this.ask(), rest);
    else scene?.__r3f?.root.getState().invalidate();
  }
}

/**
 * Put image and scene over each other.
 * @param {SceneCamera} camera
 * @param {((view: View, sides: number[], width: number, height: number) => any) | null} scene draws
 *   it into a canvas, and returns that, and left, top, width and height of its part
 */
function compose({ room, canvas, image, view }, scene) {
  if (!view) return;
  const sharp = Math.min(MOST, devicePixelRatio);
  const width = Math.max(1, Math.round(room.clientWidth * sharp));
  const height = Math.max(1, Math.round(room.clientHeight * sharp));
  const frame = framing(view, width, height);
  const drawn = frame && scene?.(view, frame.sides, width, height);
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  /** @param {number} alpha */
  const drawImage = (alpha) => {
    const [x, y, w, h] = frame?.image || fitted(image, width, height);
    Object.assign(context, { globalAlpha: alpha, imageSmoothingEnabled: false });
    context.drawImage(image, x, y, w, h);
    context.globalAlpha = 1;
  };
  context.fillStyle = "#000";
  context.fillRect(0, 0, width, height);
  if (view.behind || !drawn) drawImage(1);
  if (!drawn) return;
  context.imageSmoothingEnabled = true;
  const [x, y, w, h] = drawn.part;
  context.drawImage(drawn.canvas, x, y, w, h, 0, 0, width, height);
  if (view.over > 0) drawImage(view.over);
}

/** Where an image is in a window, whole and as large as it may be.
 * @param {HTMLCanvasElement} image @param {number} width @param {number} height */
function fitted(image, width, height) {
  const scale = Math.min(width / image.width, height / image.height);
  const [w, h] = [image.width * scale, image.height * scale];
  return [(width - w) / 2, (height - h) / 2, w, h];
}

/** @type {any} */
let eye = null;

/** Whether a camera of three.js is that of a picture here. @param {any} camera */
others.has = (camera) => camera === eye;

/**
 * Draw the pictures that are due; called at the beginning of each picture of the view.
 * @param {any} renderer @param {any} scene @param {any} main the camera of the view
 * @param {any[]} helpers objects that belong to the view alone
 * @param {any} names all names
 */
function drawSceneCameras(renderer, scene, main, helpers, names) {
  if (!open.size || main !== window.__viserMutable?.camera) return;
  const now = performance.now();
  const changes = settling.picture(now);
  for (const camera of open) {
    if (!camera.view || !(camera.isNew || changes)) continue;
    if (now < camera.drawn + PERIOD) {
      camera.isNew = true;
      camera.ask();
      continue;
    }
    camera.isNew = false;
    camera.drawn = now;
    compose(camera, (view, sides, width, height) => {
      const hidden = hide(new Set(view.hidden), helpers, names);
      try {
        return drawScene(renderer, scene, main, view, sides, width, height);
      } finally {
        for (const object of hidden) object.visible = true;
      }
    });
  }
}

others.draw = drawSceneCameras;

/**
 * Hide what is not in the picture of a camera; returns what was visible of it.
 * @param {Set<string>} displays @param {any[]} helpers @param {any} names
 */
function hide(displays, helpers, names) {
  const { nodeRefFromName = {} } = window.__viserMutable || {};
  /** @param {string} name */
  const owner = (name) => OWNER.exec(name)?.[1] || "";
  const objects = [...helpers];
  for (const [name, node] of Object.entries(nodeRefFromName))
    if (owner(name) === TOOL || displays.has(owner(name))) objects.push(node);
  // All names are one object.
  const tree = /** @type {any} */ (window).__viserSceneTree?.getState() || {};
  if (
    displays.size &&
    Object.entries(tree).some(
      ([name, node]) =>
        /** @type {any} */ (node)?.message.type === "LabelMessage" && displays.has(owner(name)),
    )
  )
    objects.push(names);
  const shown = objects.filter((object) => object?.visible);
  for (const object of shown) object.visible = false;
  return shown;
}

/**
 * Draw the scene into a corner of the canvas of the view.
 * @param {any} renderer @param {any} scene @param {any} main
 * @param {View} view @param {number[]} sides @param {number} width @param {number} height
 * @returns {{canvas: HTMLCanvasElement, part: number[]} | null} null where there is no view
 */
function drawScene(renderer, scene, main, view, sides, width, height) {
  eye ??= makeEye(main);
  aim(eye, view, sides);
  const { domElement: canvas } = renderer;
  const fits = Math.min(1, canvas.width / width, canvas.height / height);
  const [w, h] = [Math.floor(width * fits), Math.floor(height * fits)];
  if (!w || !h) return null;
  /** @type {number[]} */
  const before = [];
  renderer.getViewport({
    copy: (/** @type {any} */ { x, y, z, w }) => before.push(x, y, z, w),
  });
  const ratio = renderer.getPixelRatio(),
    alpha = renderer.getClearAlpha();
  renderer.setViewport(0, 0, w / ratio, h / ratio);
  renderer.setClearAlpha(0);
  try {
    renderer.render(scene, eye);
  } finally {
    renderer.setViewport(...before);
    renderer.setClearAlpha(alpha);
  }
  return { canvas, part: [0, canvas.height - h, w, h] };
}

/** A camera whose picture is given by its sides. @param {any} main */
function makeEye(main) {
  const made = new main.constructor();
  made.updateProjectionMatrix = () => {
    const [left, right, top, bottom] = made.userData.sides || [-1, 1, 1, -1];
    const ends = [made.near, made.far, made.coordinateSystem, made.reversedDepth];
    made.projectionMatrix.makePerspective(left, right, top, bottom, ...ends);
    made.projectionMatrixInverse.copy(made.projectionMatrix).invert();
  };
  return made;
}

/** @param {any} camera of three.js @param {View} view @param {number[]} sides */
function aim(camera, view, sides) {
  const root = window.__viserMutable?.nodeRefFromName?.[""];
  const [w, x, y, z] = view.wxyz;
  camera.near = NEAR;
  camera.far = Math.max(view.far, 1.001 * NEAR);
  camera.userData.sides = sides;
  camera.updateProjectionMatrix();
  camera.position.set(...view.position);
  camera.quaternion.set(x, y, z, w);
  if (root) {
    camera.position.applyMatrix4(root.matrixWorld);
    camera.quaternion.premultiply(root.getWorldQuaternion(camera.quaternion.clone()));
  }
  // Half a turn about x: the camera looks along z, with y downwards.
  camera.quaternion.multiply(camera.quaternion.clone().set(1, 0, 0, 0));
}

// @ts-check
/* Makes mouse and fingers move viser's camera as RViz's views do, with RViz's radians
 * and metres per pixel: left turns, middle or Shift+left moves, right or the wheel
 * zooms; one finger turns, two move and zoom. While a camera moves about a focal point,
 * a flat disc shows where that is.
 *
 * The type of view is `window.sambotViz.view` ({kind, focalSize, focalFixed}), or the
 * data of an element that the toolbar makes. viser's camera-controls keeps the camera;
 * its own mouse, fingers and keys are switched off. Without it, nothing is done here.
 *
 * All coordinates are those of three.js, where "up" is that of the camera.
 */

/** viser's and three.js' objects have no types here. @type {any} */
const globals = window;
const state = { kind: "", focal: false };
globals.sambotVizMouse = state;
const page = () => globals.__viserMutable;
const controls = () => page()?.cameraControl;

// RViz's radians per pixel, and its part of the distance per pixel and wheel unit.
const TURN = 0.005;
const ZOOM = 0.01;
const WHEEL = 0.001;
/** Units of the wheel in a pixel or a line that a browser reports; a notch has 120. */
const WHEEL_UNITS = [1.2, 40, 120];
/** RViz's steepest pitch is this far from straight down: there yaw is still defined. */
const POLE = 0.001;
/** XYOrbit and its kind look over their focal point, by this part of the distance. */
const RAISED = 0.2;
/** Pictures that viser draws for others see layer 0 only. */
const DISC_LAYER = 30;

/** @typedef {[number, number, number]} Vector */
/** @param {Vector} a @param {Vector} b @param {number} [k] @returns {Vector} a + k b */
const plus = (a, b, k = 1) => [a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2]];
/** @param {Vector} a @param {Vector} b */
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
/** @param {Vector} a @param {Vector} b @returns {Vector} */
const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
/** @param {Vector} a @returns {Vector} */
const unit = (a) => {
  const k = 1 / Math.sqrt(dot(a, a));
  return [k * a[0], k * a[1], k * a[2]];
};

/** Where the camera is and which way its picture lies. */
const pose = () => {
  const c = controls();
  const vector = c.camera.position.clone();
  /** @type {Vector} */
  const position = c.getPosition(vector).toArray();
  /** @type {Vector} */
  const target = c.getTarget(vector).toArray();
  const away = plus(position, target, -1);
  const distance = Math.sqrt(dot(away, away));
  const back = unit(away);
  /** @type {Vector} */
  const above = unit(c.camera.up.toArray());
  const right = unit(cross(above, back));
  const up = cross(back, right);
  return { position, target, distance, back, above, right, up };
};
/** What stays in its place while the camera turns or zooms. */
const pivot = () => {
  const p = pose();
  if (state.kind === "FPS") return p.position;
  return raised() ? plus(p.target, p.up, -RAISED * p.distance) : p.target;
};
const raised = () => state.kind === "XYOrbit" || state.kind === "ThirdPersonFollower";
const above = () => state.kind === "TopDownOrtho";

/** From a camera of RViz's field of view to the target: one without perspective is far away. */
const reach = () => {
  const { fov } = controls().camera;
  const wide = fov < 1 ? Math.tan((fov * Math.PI) / 360) / Math.tan(Math.PI / 8) : 1;
  return wide * pose().distance;
};

/** @param {Vector} by */
const shift = (by) => {
  const at = plus(pose().target, by);
  controls().moveTo(at[0], at[1], at[2], false);
};
/** Do something about the pivot. @param {() => void} act */
const about = (act) => {
  const before = pivot();
  act();
  shift(plus(before, pivot(), -1));
};
/** @param {number} dx @param {number} dy [px] */
const turn = (dx, dy) =>
  about(() => {
    const c = controls();
    // Without perspective, only TopDownOrtho looks straight down.
    const pole = c.camera.fov < 1 ? 3 * POLE : 0;
    // From above, RViz turns the picture; else it turns the camera.
    if (above()) c.rotate(TURN * dx, 0, false);
    else c.rotate(-TURN * dx, Math.max(-TURN * dy, pole - c.polarAngle), false);
  });
/** Metres at the focal point per pixel. @param {number} distance */
const metres = (distance) =>
  (2 * distance * Math.tan((controls().camera.fov * Math.PI) / 360)) /
  (page().canvas.clientHeight || 1);
/** @param {number} dx @param {number} dy [px] @param {{x: number, y: number}} at */
const move = (dx, dy, at) => {
  const p = pose();
  if (state.kind === "FPS")
    return shift(plus(plus([0, 0, 0], p.right, 0.01 * dx), p.up, -0.01 * dy));
  if (raised()) {
    const from = onGround(at.x - dx, at.y - dy);
    const to = onGround(at.x, at.y);
    if (!from || !to) return;
    const way = plus(from, to, -1);
    const length = Math.sqrt(dot(way, way));
    return shift(plus([0, 0, 0], way, Math.min(1, 1 / (length || 1))));
  }
  const size = metres(p.distance);
  shift(plus(plus([0, 0, 0], p.right, -dx * size), p.up, dy * size));
};
/**
 * Where the ray through a pixel meets the level plane of the focal point.
 * @param {number} x @param {number} y [px] of the window @returns {Vector | null}
 */
const onGround = (x, y) => {
  const p = pose();
  const box = page().canvas.getBoundingClientRect();
  const pixel = metres(1);
  const aside = (x - box.left - box.width / 2) * pixel;
  const upwards = (box.top + box.height / 2 - y) * pixel;
  const ray = plus(plus(plus([0, 0, 0], p.back, -1), p.right, aside), p.up, upwards);
  const reach = dot(plus(pivot(), p.position, -1), p.above) / dot(ray, p.above);
  return reach > 0 && Number.isFinite(reach) ? plus(p.position, ray, reach) : null;
};
/** Farther by a part of the distance, nearer for a negative one. @param {number} by */
const zoom = (by) =>
  about(() => {
    const far = Math.max(0.01, 1 + by);
    const c = controls();
    // From above, RViz changes the scale: the inverse of the distance here.
    c.dollyTo(c.distance * (above() ? 1 / Math.max(0.01, 1 - by) : far), false);
  });
/** Away along the line of sight. @param {number} length [m] */
const retreat = (length) => shift(plus([0, 0, 0], pose().back, length));
/** @param {number} dy [px], down is positive @param {boolean} held Shift */
const rightDrag = (dy, held) => {
  if (state.kind === "FPS") retreat(0.1 * dy);
  else if (held && state.kind === "Orbit") retreat(ZOOM * reach() * dy);
  else zoom(ZOOM * dy);
};
/** @param {number} units RViz's, away from the user is positive @param {boolean} held */
const wheel = (units, held) => {
  if (state.kind === "FPS") retreat(-0.01 * units);
  else if (held && state.kind === "Orbit") retreat(-WHEEL * reach() * units);
  else zoom(-WHEEL * units);
};

/** Set what differs. @param {any} object @param {string} key @param {unknown} value */
const put = (object, key, value) => {
  if (object[key] !== value) object[key] = value;
};
const view = () => {
  if (globals.sambotViz?.view) return globals.sambotViz.view;
  /** @type {HTMLElement | null} */
  const mark = document.querySelector("[data-sambot-view]");
  return mark && { kind: mark.dataset.sambotView };
};
/** Take the type of view, and switch viser's own mouse off; false without a camera. */
const refresh = () => {
  const c = controls();
  const now = view();
  if (!c || !now) return false;
  state.kind = now.kind || "";
  put(c, "minPolarAngle", above() ? 0 : POLE);
  put(c, "maxPolarAngle", Math.PI - POLE);
  hideCrosshair();
  for (const actions of [c.mouseButtons, c.touches]) {
    for (const key of Object.keys(actions)) put(actions, key, 0);
  }
  return true;
};
setInterval(refresh, 200);

/** @param {Event} event */
const onCanvas = (event) => page() && event.target === page().canvas;
/** The presses that began in the view. @type {Map<number, {x: number, y: number}>} */
const presses = new Map();
window.addEventListener(
  "pointerdown",
  (event) => {
    if (!onCanvas(event) || !refresh()) return;
    // Browsers capture a finger for what it touches; viser takes a captured pointer for
    // one of its handles being dragged, and gives the tools no click.
    if (event.pointerType === "touch" && page().canvas.hasPointerCapture(event.pointerId))
      page().canvas.releasePointerCapture(event.pointerId);
    presses.set(event.pointerId, { x: event.clientX, y: event.clientY });
  },
  true,
);
window.addEventListener(
  "pointermove",
  (event) => {
    const last = presses.get(event.pointerId);
    if (!last) return;
    const at = { x: event.clientX, y: event.clientY };
    if (event.pointerType === "touch") {
      if (!before.length) requestAnimationFrame(moveFingers);
      if (!before.length) before = [...presses.values()];
      presses.set(event.pointerId, at);
      return;
    }
    // The button was released where this page does not hear of it.
    if (!event.buttons) return release(event);
    const dx = at.x - last.x;
    const dy = at.y - last.y;
    presses.set(event.pointerId, at);
    // A rectangle, and whatever else viser drags, keeps the camera where it is.
    if (!controls()?.enabled || (!dx && !dy)) return;
    if (event.buttons & 4 || (event.buttons & 1 && event.shiftKey)) move(dx, dy, at);
    else if (event.buttons & 1) turn(dx, dy);
    else if (event.buttons & 2) rightDrag(dy, event.shiftKey);
    showFocal(true);
  },
  true,
);
/** Where the fingers were in the last picture. @type {{x: number, y: number}[]} */
let before = [];
/** One finger turns; two move by their middle, and zoom by their distance. */
const moveFingers = () => {
  const [a, b] = before;
  const [c, d] = presses.values();
  const fingers = before.length;
  before = [];
  if (!fingers || fingers !== presses.size || !controls()?.enabled) return;
  if (fingers === 1) turn(c.x - a.x, c.y - a.y);
  if (fingers === 2) {
    const middle = { x: (c.x + d.x) / 2, y: (c.y + d.y) / 2 };
    move(middle.x - (a.x + b.x) / 2, middle.y - (a.y + b.y) / 2, middle);
    const was = Math.hypot(a.x - b.x, a.y - b.y);
    const now = Math.hypot(c.x - d.x, c.y - d.y);
    if (state.kind === "FPS") retreat(ZOOM * (was - now));
    else if (now) zoom(was / now - 1);
  }
  showFocal(true);
};
/** @param {PointerEvent} event */
const release = (event) => {
  if (before.length) moveFingers();
  if (!presses.delete(event.pointerId)) return;
  if (!presses.size) showFocal(false);
};
window.addEventListener("pointerup", release, true);
window.addEventListener("pointercancel", release, true);
window.addEventListener(
  "contextmenu",
  (event) => {
    if (onCanvas(event)) event.preventDefault();
  },
  true,
);
window.addEventListener(
  "wheel",
  (event) => {
    if (!onCanvas(event) || !refresh()) return;
    event.preventDefault();
    if (!controls().enabled) return;
    // With Shift, browsers turn the wheel sideways; a pinch on a touch pad comes as
    // small steps with Ctrl.
    const steps = (event.deltaY || event.deltaX) * (event.ctrlKey ? 10 : 1);
    wheel(-steps * WHEEL_UNITS[event.deltaMode], event.shiftKey);
  },
  { capture: true, passive: false },
);

/** The ball in the middle of viser's crosshair. @type {any} */
let ball = null;
/** viser shows a crosshair where the camera looks; RViz has its disc. */
const hideCrosshair = () => {
  if (ball?.parent) return;
  page().scene.traverse((/** @type {any} */ object) => {
    if (
      object.isMesh &&
      object.material?.isMeshBasicMaterial &&
      object.geometry?.type === "SphereGeometry"
    )
      ball = object;
  });
  ball?.parent.traverse((/** @type {any} */ object) => object.layers.disableAll());
};
/** @type {any} */
let disc = null;
/** A ball to be flattened; three.js' classes are those of the crosshair's. */
const makeDisc = () => {
  if (!ball) return null;
  const made = new ball.constructor(
    new ball.geometry.constructor(0.5, 24, 12),
    new ball.material.constructor({ transparent: true, opacity: 0.5, depthWrite: false }),
  );
  made.layers.set(DISC_LAYER);
  made.visible = false;
  return made;
};
/** @param {boolean} on */
const showFocal = (on) => {
  const show = on && (state.kind === "Orbit" || raised());
  if (!show && !disc) return;
  if (!disc) disc = makeDisc();
  if (!disc) return;
  const m = page();
  const { focalSize = 0.05, focalFixed = true } = view() || {};
  if (disc.parent !== m.scene) m.scene.add(disc);
  m.camera.layers.enable(DISC_LAYER);
  if (show) {
    const p = pose();
    const size = focalFixed ? focalSize : focalSize * reach();
    disc.position.set(...pivot());
    disc.quaternion.setFromUnitVectors(
      disc.position.clone().set(0, 0, 1),
      disc.position.clone().set(...p.above),
    );
    disc.scale.set(size, size, size / 5);
    disc.material.color.set(raised() ? 0x00ffff : 0xffff00);
  }
  state.focal = disc.visible = show;
  m.requestRender?.();
};

// RViz has no keys that move the camera; viser moves it while one of these is held. To
// viser they are released before the next picture.
const KEYS = [
  "KeyW",
  "KeyA",
  "KeyS",
  "KeyD",
  "KeyQ",
  "KeyE",
  "ArrowUp",
  "ArrowDown",
  "ArrowLeft",
  "ArrowRight",
];
window.addEventListener("keydown", (event) => {
  if (KEYS.includes(event.code))
    document.dispatchEvent(new KeyboardEvent("keyup", { code: event.code }));
});

// @ts-check
/* The camera of this page. Hands move it (rviz_mouse.js), and with the frame that the view follows
 * it moves by itself, in the same picture as that frame. The server says which frame that is, and
 * asks for a camera when somebody wants one; it hears where the camera is relative to the frame,
 * with the number of the last one that it has asked for.
 *
 * viser's camera-controls has the camera, in the coordinates of three.js. All poses here are in
 * those of viser's world, which are our fixed frame. */

/** @typedef {[number, number, number]} Vector */
/** @typedef {{position: Vector, yaw: number}} Pose */
/**
 * @typedef {{node: string, place: boolean, turns: boolean, at: [number, number, number, number]}} Followed
 *   node: the name of what is followed, "" for what does not move; place: whether it has a place; turns:
 *   whether the camera turns with it; at: x, y, z and yaw where the page does not know better
 * @typedef {{position: Vector, look_at: Vector, up: Vector, fov: number, near: number, far: number, scale: number | null}} Asked
 *   scale: pixels per metre of a view from straight above, which decides the distance
 * @typedef {{number: number, follows: Followed, camera: Asked | null}} Told
 * @typedef {{camera: number, position: Vector, look_at: Vector, up: Vector, fov: number, scale: number | null}} Report
 */

/** So often is the camera reported at most [ms]. */
const PERIOD = 40;
/** What differs by less than this part of the distance is the same. */
const SAME = 1e-7;
/** No camera is nearer to what it looks at [m]. */
const NEAREST = 0.001;

/** For tests: the last camera that was asked for and is shown, and whether all is reported.
 * @type {{number: number | null, reported: boolean}} */
export const shown = { number: null, reported: false };

/** What the server has said last, and whether its camera is to be shown. @type {Told | null} */
let told = null;
let isNew = false;
/** The pose of the followed frame that the camera is placed for. @type {Pose | null} */
let last = null;
/** Whether the distance is decided by a scale, and by which height of the picture [px]. */
let scaled = false,
  height = 0;
/** What was reported last. @type {Report | null} */
let sent = null;
let sentAt = -Infinity,
  timer = 0;
/** @type {(report: Report) => void} */
let report = () => undefined;

const page = () => window.__viserMutable;

/** The view has its camera; until then viser_address.js hides it. */
const beSeen = () => globalThis.document?.documentElement?.classList.remove("no-camera");

/** Send reports by this function. @param {(report: Report) => void} send */
export function reportCamera(send) {
  report = send;
}

/** Take what the server says. @param {Told} message */
export function takeCamera(message) {
  isNew = message.camera !== null && (isNew || message.number !== shown.number);
  // A page that comes back keeps its camera, where it is.
  if (shown.number === null && !message.camera) {
    last = null;
    shown.number = message.number;
  }
  told = message;
  shown.reported = false;
  // What a hand does from now on it does to this camera. The first one waits for a picture: before
  // it, viser puts a camera of its own.
  if (shown.number !== null) place();
  page()?.requestRender?.();
}

/** There is no connection any more: the next server knows nothing of this camera. */
export function loseCamera() {
  told = sent = last = null;
  isNew = false;
  shown.number = null;
  beSeen();
}

/** @param {Vector} a @param {Vector} b @param {number} [k] @returns {Vector} a + k b */
const plus = (a, b, k = 1) => [a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2]];
/** @param {Vector} a @param {number} yaw @returns {Vector} turned about the vertical */
const turned = ([x, y, z], yaw) => {
  const c = Math.cos(yaw),
    s = Math.sin(yaw);
  return [c * x - s * y, s * x + c * y, z];
};
/** A point of the followed frame in the fixed frame. @param {Pose} pose @param {Vector} point */
const out = (pose, point) => plus(pose.position, turned(point, pose.yaw));
/** @param {Pose} pose @param {Vector} point of the fixed frame */
const into = (pose, point) => turned(plus(point, pose.position, -1), -pose.yaw);

/** A point of the fixed frame for three.js. @param {any} root @param {Vector} point */
const toThree = (root, point) =>
  root.localToWorld(
    page()
      ?.camera.position.clone()
      .set(...point),
  );
/** @param {any} root @param {any} vector @returns {Vector} */
const fromThree = (root, vector) => root.worldToLocal(vector.clone()).toArray();
/** A direction of the fixed frame for three.js. @param {any} root @param {Vector} way */
const wayToThree = (root, way) => toThree(root, way).sub(toThree(root, [0, 0, 0]));

/** Where the followed frame is in the picture that is about to be drawn.
 * @param {any} root @param {Followed} follows @param {Pose | null} before @returns {Pose} */
function poseOf(root, { node, place, turns, at }, before) {
  const object = node ? page()?.nodeRefFromName?.[node] : null;
  if (!object) {
    // What has lost its place, or is on its way, is left where it was.
    const known = !place || node ? before : null;
    return known || { position: [at[0], at[1], at[2]], yaw: turns ? at[3] : 0 };
  }
  object.updateWorldMatrix(true, false);
  const vector = page()?.camera.position.clone();
  const position = fromThree(root, vector.setFromMatrixPosition(object.matrixWorld));
  if (!turns) return { position, yaw: 0 };
  const ahead = fromThree(root, object.localToWorld(vector.set(1, 0, 0)));
  const [x, y] = plus(ahead, position, -1);
  return { position, yaw: Math.atan2(y, x) };
}

/** Move the camera as far as the frame that it follows. @param {any} root @param {Pose} now */
function follow(root, now) {
  const before = last;
  last = now;
  if (!before) return;
  const yaw = now.yaw - before.yaw;
  const moved = now.position.some((value, i) => value !== before.position[i]);
  if (!moved && !yaw) return;
  const { cameraControl: controls, camera } = /** @type {any} */ (page());
  const target = fromThree(root, controls.getTarget(camera.position.clone()));
  const { x, y, z } = toThree(root, out(now, into(before, target)));
  controls.moveTo(x, y, z, false);
  // Of a view that is upside down, the vertical of the controls is the other way.
  const side = Math.sign(wayToThree(root, [0, 0, 1]).dot(camera.up)) || 1;
  if (yaw) controls.rotate(side * yaw, 0, false);
}

/** Show the camera that was asked for. @param {any} root @param {Asked} asked @param {Pose} pose */
function show(root, asked, pose) {
  const viser = /** @type {any} */ (page());
  const { cameraControl: controls, camera } = viser;
  viser.configuredMaxOrbitDistance = controls.maxDistance = Infinity;
  controls.minDistance = NEAREST;
  scaled = asked.scale !== null;
  height = viser.canvas.clientHeight || 1;
  let eye = asked.position;
  if (asked.scale !== null) {
    const away = plus(eye, asked.look_at, -1);
    const distance = height / asked.scale / 2 / Math.tan(asked.fov / 2);
    eye = plus(asked.look_at, away, distance / Math.hypot(...away));
  }
  camera.up.copy(wayToThree(root, turned(asked.up, pose.yaw))).normalize();
  controls.updateCameraUp();
  const from = toThree(root, out(pose, eye)),
    to = toThree(root, out(pose, asked.look_at));
  controls.setLookAt(from.x, from.y, from.z, to.x, to.y, to.z, false);
  camera.near = asked.near;
  camera.far = asked.far;
  camera.fov = (asked.fov * 180) / Math.PI;
  camera.updateProjectionMatrix();
}

/** As many pixels per metre as before, in a window of another size. */
function keepScale() {
  const { canvas, cameraControl: controls } = /** @type {any} */ (page());
  const now = canvas.clientHeight;
  if (!scaled || !now || now === height) return;
  controls.dollyTo((controls.distance * now) / height, false);
  height = now;
}

/** Where the camera is relative to the followed frame. @param {any} root @param {Pose} pose @returns {Report} */
function camera(root, pose) {
  const { cameraControl: controls, camera, canvas } = /** @type {any} */ (page());
  const vector = camera.position.clone();
  const position = into(pose, fromThree(root, controls.getPosition(vector)));
  const look_at = into(pose, fromThree(root, controls.getTarget(vector)));
  // Up in the picture: where the camera looks straight down, that of the controls says nothing.
  const back = controls.getPosition(vector).sub(controls.getTarget(vector.clone())).normalize();
  const above = camera.up.clone().addScaledVector(back, -camera.up.dot(back)).normalize();
  const origin = fromThree(root, vector.clone().set(0, 0, 0));
  const up = turned(plus(fromThree(root, above), origin, -1), -pose.yaw);
  const fov = (camera.fov * Math.PI) / 180;
  const half = controls.distance * Math.tan(fov / 2);
  const scale = scaled ? (canvas.clientHeight || 1) / 2 / half : null;
  return { camera: shown.number ?? 0, position, look_at, up, fov, scale };
}

/** Whether two reports say the same. @param {Report} a @param {Report} b */
function same(a, b) {
  const small = SAME * Math.hypot(...plus(a.position, a.look_at, -1));
  const near = (/** @type {Vector} */ v, /** @type {Vector} */ w) =>
    Math.hypot(...plus(v, w, -1)) <= small;
  return (
    a.camera === b.camera &&
    Math.abs(a.fov - b.fov) < SAME &&
    Math.hypot(...plus(a.up, b.up, -1)) < SAME &&
    Math.abs((a.scale || 1) / (b.scale || 1) - 1) < SAME &&
    near(a.position, b.position) &&
    near(a.look_at, b.look_at)
  );
}

/** Report the camera, if it is another one than before, now or as soon as it may be. */
function tell() {
  const root = page()?.nodeRefFromName?.[""];
  if (!root || !told || !last || shown.number === null) return;
  const now = camera(root, last);
  shown.reported = Boolean(sent && same(now, sent));
  if (shown.reported) return;
  const rest = sentAt + PERIOD - performance.now();
  clearTimeout(timer);
  if (rest > 0) {
    timer = window.setTimeout(tell, rest);
    return;
  }
  sent = now;
  sentAt = performance.now();
  shown.reported = true;
  report(now);
}

/** Show the camera that was asked for, if it is new; else go with the followed frame. */
function place() {
  const viser = page();
  const root = viser?.nodeRefFromName?.[""];
  if (!viser?.cameraControl || !root || !told) return;
  // One that was asked for may follow another frame.
  const pose = poseOf(root, told.follows, isNew ? null : last);
  if (isNew && told.camera) {
    show(root, told.camera, pose);
    shown.number = told.number;
    last = pose;
  } else follow(root, pose);
  isNew = false;
  beSeen();
}

/** Called before each picture, when viser has placed the nodes in it. */
export function moveCamera() {
  if (!told || !page()?.cameraControl) return;
  place();
  keepScale();
  tell();
}

if (globalThis.window) window.sambotVizCamera = shown;

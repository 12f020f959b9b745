// @ts-check
/* What viser is told of the scene, and when it takes it up, so that what belongs together is in one
 * picture. By itself viser puts poses into the next picture and what React makes into the one after
 * it, and a node that gets another file (points, lines, maps) is not drawn until the file is read.
 *
 * Here messages are handed to viser as soon as they are there and the picture before was drawn. It
 * does not get their poses yet: these are taken with the picture in which all of their files are
 * read. Until then the picture before stays. Points that only have other places or colours are not
 * read by viser at all: they get them with that picture. */

import { pointsOf, refilling } from "./refill.js";

/** What acts without React. */
const POSES = new Set([
  "SetPositionMessage",
  "SetOrientationMessage",
  "SetSceneNodeVisibilityMessage",
]);
/** The name in a message that says that the next ones belong to those before it (outbox.py). */
const MORE = "~more";
/** What takes longer, such as the file of a mesh, comes into a later picture [ms]. */
const LONGEST = 200;
/** Minimum number of waiting pictures, on a machine that draws seldom. */
const PICTURES = 3;
/** Before viser takes messages (-100000), and right after it. */
const FIRST = -200000,
  SECOND = -99999;

/** @type {Set<(messages: any[]) => void>} */
const listeners = new Set();

/** Number of poses at the front of viser's queue that wait for the rest. */
let held = 0;
/** Whether there is a rest that no picture shows yet, and the nodes whose files are read for it. */
let isComing = false;
/** @type {Set<string>} */
let files = new Set();
/** For what messages are taken: nothing special, to be handed, a picture, or one that is left out. */
let now = /** @type {"" | "handed" | "drawn" | "left out"} */ ("");
let isAsked = false,
  isLeftOut = false;
/** What is done with that picture, by the node. @type {Map<string, () => void>} */
let fills = new Map();
/** viser's properties of nodes with a file, and the object of each that gives way to another one.
 * @type {Map<string, {props: any, leaves?: any}>} */
const made = new Map();
/** Since when something is waited for, and with how many pictures. */
let since = 0,
  pictures = 0;
/** Whether more is to come of what is in the queue. */
let isPartial = false;

const page = () => window.__viserMutable;

/** Call a function with the messages that viser takes up; returns a function that ends that.
 * @param {(messages: any[]) => void} listener */
export function followMessages(listener) {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/**
 * Part poses from what they wait for.
 * @param {any[]} messages
 * @returns {{poses: any[], rest: any[], files: Set<string>}} files: the nodes that get one
 */
export function parted(messages) {
  /** @type {any[]} */
  let poses = [];
  /** @type {any[]} */
  const rest = [];
  /** @type {Set<string>} */
  const files = new Set();
  for (const message of messages) {
    const { type, name, updates, props } = message;
    if (name === MORE) continue;
    if (POSES.has(type)) {
      poses.push(message);
      continue;
    }
    if (type === "RemoveSceneNodeMessage" || props) {
      // The poses of the node that was there before are not those of another one.
      const isOld = (/** @type {string} */ other) =>
        other === name || (!props && other.startsWith(`${name}/`));
      rest.push(...poses.filter((pose) => isOld(pose.name)));
      poses = poses.filter((pose) => !isOld(pose.name));
      for (const other of files) if (isOld(other)) files.delete(other);
    }
    if (type === "GlbMessage" || updates?.glb_data) files.add(name);
    rest.push(message);
  }
  return { poses, rest, files };
}

/**
 * Part from other messages what `refill.js` does.
 * @param {any[]} messages
 * @returns {any[]} the rest
 */
function withoutFills(messages) {
  /** @type {Set<string>} */
  const begun = new Set();
  for (const { type, name, props } of messages)
    if (props || type === "RemoveSceneNodeMessage") begun.add(name);
  const isBegun = (/** @type {string} */ name) =>
    [...begun].some((other) => name === other || name.startsWith(`${other}/`));
  return messages.filter((message) => {
    const { name, updates } = message;
    const content = updates?.glb_data;
    if (!content || Object.keys(updates).length > 1) return true;
    const object = pointsOf(page()?.nodeRefFromName?.[name]);
    const known = made.get(name);
    if (!known || !object || known.leaves === object || isBegun(name)) return true;
    const fill = refilling(object, content);
    if (!fill) return true;
    fills.set(name, () => {
      fill();
      // Whatever makes viser read its file again reads this one.
      known.props.glb_data = content;
    });
    return false;
  });
}

/** Remember what viser makes of files. @param {any[]} messages that it takes */
function remember(messages) {
  for (const { type, name, props, updates } of messages) {
    if (type === "GlbMessage") made.set(name, { props });
    else if (updates?.glb_data && made.has(name))
      // It is read while the one before is still there, and viser copies the properties.
      made.set(name, { props: {}, leaves: pointsOf(page()?.nodeRefFromName?.[name]) });
    else if (props) made.delete(name);
    else if (type === "RemoveSceneNodeMessage")
      for (const other of made.keys())
        if (other === name || other.startsWith(`${name}/`)) made.delete(other);
  }
}

/** Give points what belongs to the picture that is drawn now. */
function fill() {
  for (const [name, one] of fills) if (made.has(name)) one();
  fills.clear();
}

/** Hand what has come to viser, if the picture of what came before was drawn. */
function hand() {
  isAsked = false;
  const viser = page();
  const { messageQueue: queue = [], drainMessageQueue: drain } = viser || {};
  // What has nothing to wait for comes with the next picture anyway, and in a hidden page there
  // are none.
  if (isComing || !queue.length || document.hidden) return;
  viser?.requestRender?.();
  const wasPartial = isPartial;
  isPartial = queue.at(-1).name === MORE;
  if (isPartial && !wasPartial) beginWaiting();
  if (isPartial && mayWait()) return;
  isPartial = false;
  if (!drain || viser?.firstMessageBatch || queue.every(({ type }) => POSES.has(type))) return;
  if (isAskedFor(queue)) return;
  now = "handed";
  drain();
  now = "";
}

/** Whether somebody asks for a picture: it has all that was said before. @param {any[]} queue */
const isAskedFor = (queue) => queue.some(({ type }) => type === "GetRenderRequestMessage");

function beginWaiting() {
  since = performance.now();
  pictures = 0;
}
const mayWait = () => performance.now() - since < LONGEST || pictures < PICTURES;

/** Look at the queue when all that comes together is in it. */
function askLater() {
  if (!isAsked) queueMicrotask(hand);
  isAsked = true;
}

/** Give viser what it may take. @param {any[]} queue viser's @param {any} take its `splice`
 * @param {any[]} args of it @returns {any[]} */
function given(queue, take, args) {
  if (now === "handed") {
    const all = take.apply(queue, args);
    const { poses, rest, files: named } = parted(withoutFills(all));
    // It is empty now; a call with a hundred thousand arguments is none.
    for (const pose of poses) queue[queue.length] = pose;
    held = poses.length;
    files = named;
    isComing = true;
    beginWaiting();
    return rest;
  }
  // viser has counted what it takes up to a picture that somebody asks for.
  if (isAskedFor(queue)) isComing = isPartial = false;
  else if (now === "left out") return [];
  fill();
  if (isComing && now === "drawn") return take.call(queue, 0, held);
  if (isPartial && now === "drawn") return [];
  return take.apply(queue, args).filter((/** @type {any} */ { name }) => name !== MORE);
}

/** @param {any} viser its page */
function follow({ messageQueue: queue }) {
  const { splice, push } = queue;
  queue.push = (/** @type {any[]} */ ...more) => {
    askLater();
    return push.apply(queue, more);
  };
  queue.splice = (/** @type {any[]} */ ...args) => {
    const taken = given(queue, splice, args);
    remember(taken);
    if (taken.length) for (const listener of listeners) listener(taken);
    return taken;
  };
}

/** Whether files are still read for what comes. */
function isReading() {
  const nodes = page()?.nodeRefFromName || {};
  return mayWait() && [...files].some((name) => !nodes[name]);
}

/** Draw pictures of one time. @param {any} scene of three.js, when there is one */
export function drawTogether(scene) {
  const store = scene.__r3f?.root;
  const internal = store?.getState().internal;
  const begin = () => {
    // Whoever has a priority draws instead of the library.
    if (isLeftOut) internal.priority -= 1;
    // What was coming from a server before is not waited for.
    if (page()?.firstMessageBatch) isComing = isPartial = false;
    isLeftOut = isComing && isReading();
    pictures += 1;
    now = isLeftOut ? "left out" : "drawn";
    if (!isLeftOut) return fill();
    internal.priority += 1;
    page()?.requestRender?.();
  };
  const end = () => {
    now = "";
    if (isLeftOut) return;
    if (isComing || isPartial) askLater();
    isComing = false;
  };
  internal?.subscribe({ current: begin }, FIRST, store);
  internal?.subscribe({ current: end }, SECOND, store);
}

const hasView = new URLSearchParams(globalThis.location?.search).get("view") !== "none";
const timerOfStart =
  globalThis.window && hasView
    ? setInterval(() => {
        const viser = page();
        if (!viser?.messageQueue) return;
        clearInterval(timerOfStart);
        follow(viser);
      }, 20)
    : 0;

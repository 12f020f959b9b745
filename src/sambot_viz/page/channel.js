// @ts-check
/* The way between the rows and the server.
 *
 * Rows arrive as JSON in elements that viser puts into its own, hidden, control panel.
 * Edits leave as the message that viser's own widgets send. This is the only module
 * that uses viser's names for that.
 */

import { Rows } from "./rows.js";

export const rows = new Rows();
export const CHANNEL = "sambot-viz";

/** What is heard by those who listen to this key: a user has changed something. */
export const EDITED = "edited";
/** There is no connection any more: what was sent meanwhile shows it first. */
export const CUT = "cut";
/** An action was not done, for want of a connection. */
export const NOT_DONE = "not done";
/** The action that reports where the mouse is. */
export const HOVER = "tools/hover";
/** What a page sends without a user who means it. @param {string} id */
const byItself = (id) => id === HOVER || id.endsWith("/unfold") || id.endsWith("/shown");
/** What was sent so shortly before the connection was lost may be lost with it [ms]. */
const DOUBTFUL = 1000;

let gestures = 0;
/** A new number for all that a hand does in one go. */
export const newGesture = () => ++gestures;

/**
 * Send an edit.
 * @param {string} id @param {any} value @param {number} [gesture]
 */
export function send(id, value, gesture) {
  const row = rows.get(id);
  if (row?.part !== undefined) {
    // A number of a vector goes with the others; until the answer is here, they are as shown.
    value = rows.value(row.in).with(row.part, value);
    id = row.in;
    rows.hope(id, value);
  }
  if (!byItself(id)) rows.notify(EDITED);
  const edit = gesture === undefined ? [id, value] : [id, value, gesture];
  const action = rows.get(id)?.kind === "action", there = isConnected();
  if (online && !there && sent.size) {
    goOnline(false);
    rows.notify(CUT);
  }
  if (online) {
    post(edit);
    if (there) sent.set(id, { edit, at: action ? -Infinity : performance.now() });
  } else if (!action) waiting.set(id, edit);
  else if (!byItself(id)) rows.notify(NOT_DONE);
}

/** @param {any[]} edit */
function post(edit) {
  window.__viserMutable?.sendMessage({ type: "GuiUpdateMessage", uuid: CHANNEL, updates: { value: edit } });
}

let online = true;
/** The last edit of each row that was sent. @type {Map<string, {edit: any[], at: number}>} */
const sent = new Map();
/** The last edit of each row since the connection was lost; they are sent as soon as it is back.
 * @type {Map<string, any[]>} */
const waiting = new Map();

/** Whether there is a connection. */
export function isConnected() {
  const sender = window.__viserMutable?.sendMessage;
  // viser then has a function in this place that only complains.
  return Boolean(sender) && !String(sender).includes("not connected");
}

/** End the connection for good: this page has to be loaded again. */
export function disconnect() {
  // viser's socket is in a worker that only viser knows; it is found by what is sent to it.
  const { postMessage } = Worker.prototype;
  /** @type {Worker | undefined} */
  let worker;
  Worker.prototype.postMessage = /** @this {Worker} */ function () { worker = this; };
  try { post([]); } finally { Worker.prototype.postMessage = postMessage; }
  worker?.terminate();
}

/** Hold edits back, or send what was held back. @param {boolean} now */
export function goOnline(now) {
  online = now;
  for (const [id, { edit, at }] of sent) if (!now && performance.now() - at < DOUBTFUL) waiting.set(id, edit);
  sent.clear();
  if (!now) return;
  for (const edit of waiting.values()) post(edit);
  waiting.clear();
}

/** Do what an action row does, if it can be done now. @param {string} id @param {any[]} [args] */
export function act(id, args = []) {
  const row = rows.get(id);
  if (row && !row.off) send(id, args);
}

/** @type {WeakMap<Node, string>} */
const taken = new WeakMap();

function take() {
  /** @type {NodeListOf<HTMLScriptElement>} */
  const elements = document.querySelectorAll("script[data-sambot]");
  // All rows before what has changed since.
  for (const what of /** @type {const} */ (["rows", "changes"])) {
    for (const element of elements) {
      const { sambot, of: scope = "session" } = element.dataset;
      const text = element.textContent || "";
      if (sambot !== what || taken.get(element) === text) continue;
      taken.set(element, text);
      rows.take(scope, what, JSON.parse(text));
    }
  }
}

/** Take rows from now on. */
export function connect() {
  new MutationObserver(take).observe(document.body, { childList: true, subtree: true });
  take();
}

// @ts-check
/* The way between the rows and the server: rows arrive, and edits leave, on the page's own
 * websocket. Edits wait here while there is no connection. */

import { loseCamera, reportCamera, takeCamera } from "../view/camera.js";
import { pictures } from "./pictures.js";
import { Rows, same } from "./rows.js";
import { Socket } from "./socket.js";

export const rows = new Rows();
/** @type {Socket | null} */
let socket = null;

/** What is heard by those who listen to this key: a user has changed something. */
export const EDITED = "edited";
let editing = "";
/** The row or command that the last of these was. */
export const edited = () => editing;
/** There is no connection any more: what was sent meanwhile shows it first. */
export const CUT = "cut";
/** The server says that it stops. */
export const STOPS = "stops";
/** The presenter has ended the connection for good. */
export const REMOVED = "removed";
/** There is a connection again. */
export const ONLINE = "online";
/** Another edit waits for the connection. */
export const WAITING = "waiting";
/** A command was not called, for want of a connection. */
export const NOT_DONE = "not done";
/** A command was not called, because this user only watches. */
export const WATCHING = "watching";
/** The data of a page of a follower: the address of its origin, where control is requested,
 * and why the page may not show what is there now. */
export const FOLLOWS = "follower/state";
/** The command that reports where the mouse is. */
export const HOVER = "tools/hover";
/** The command that reports where it drags. */
export const DRAG = "tools/drag";
/** What a page sends without a user who means it. @param {string} id */
const byItself = (id) =>
  id === HOVER ||
  id === DRAG ||
  ["/unfold", "/show", "/restore", "/keep", "/find", "/greet"].some((end) => id.endsWith(end));
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
  if (rows.data(FOLLOWS)) {
    // Nothing is changed here but what the page itself keeps.
    if (!byItself(id)) rows.notify(WATCHING);
    return;
  }
  const row = rows.get(id);
  if (row?.part !== undefined) {
    // A number of a vector goes with the others; until the answer is here, they are as shown.
    value = rows.value(row.in).with(row.part, value);
    id = row.in;
    rows.hope(id, value);
  }
  if (!byItself(id)) {
    editing = id;
    rows.notify(EDITED);
  }
  const edit = gesture === undefined ? [id, value] : [id, value, gesture];
  const command = rows.knows(id);
  if (online) {
    socket?.send(edit);
    waiting.delete(id);
    if (socket?.ready) sent.set(id, { edit, at: command ? -Infinity : performance.now() });
  } else if (!command) holdBack([edit]);
  else if (!byItself(id)) rows.notify(NOT_DONE);
}

let online = true;
/** The last edit of each row that was sent. @type {Map<string, {edit: any[], at: number}>} */
const sent = new Map();
/** The last edit of each row since the connection was lost; they are sent as soon as it is back.
 * @type {Map<string, any[]>} */
const waiting = new Map();

/** The edits that wait for the connection. */
export const heldBack = () => [...waiting.values()];

/** End the connection for good: this page has to be loaded again. */
export const disconnect = () => socket?.leave();

/** Hold edits back from now on. */
export function goOffline() {
  online = false;
  const doubtful = [...sent.values()].filter(
    ({ edit: [id, value], at }) =>
      performance.now() - at < DOUBTFUL && !same(rows.value(id), shown(id, value)),
  );
  sent.clear();
  holdBack(doubtful.map(({ edit }) => edit));
}

/** Let edits wait, and show what they set. @param {any[][]} edits */
export function holdBack(edits) {
  for (const edit of edits) {
    const [id, value] = edit,
      seen = shown(id, value);
    waiting.set(id, edit);
    if (seen !== undefined) rows.hope(id, seen);
  }
  if (edits.length) rows.notify(WAITING);
}

/** What a row shows when an edit sets it, as far as the page knows. @param {string} id @param {any} value */
function shown(id, value) {
  if (rows.get(id)?.kind !== "color" || typeof value !== "string") return value;
  const hex = /^#([0-9a-f]{2})([0-9a-f]{2})([0-9a-f]{2})$/i.exec(value);
  const parts = hex ? hex.slice(1).map((part) => parseInt(part, 16)) : value.split(";").map(Number);
  return parts.length === 3 && parts.every(Number.isFinite) ? parts : undefined;
}

/** Send edits from now on. */
export function goOnline() {
  online = true;
  rows.notify(ONLINE);
}

/**
 * Send what was held back.
 * @param {(id: string) => string | null | undefined} [now] the id that a row has now; null when
 *   it is not there any more, undefined when it may still come
 * @returns {number} how many edits were dropped, for want of their row
 */
export function sendHeldBack(now = (id) => id) {
  let dropped = 0;
  for (const [id, edit] of [...waiting]) {
    const there = now(id);
    if (there === undefined) continue;
    waiting.delete(id);
    if (there === null) dropped += 1;
    else socket?.send([there, ...edit.slice(1)]);
  }
  return dropped;
}

/** Call a command, if it can be called now. @param {string} id @param {any[]} [args] */
export function act(id, args = []) {
  if (rows.can(id)) send(id, args);
  else if (rows.knows(id) && !byItself(id)) mayChange();
}

/** Whether this user may change what others see; one who only watches is told. */
export function mayChange() {
  if (rows.watching) rows.notify(WATCHING);
  return !rows.watching;
}

/** Take rows from now on. @param {string} [address] of the server */
export function connect(address = window.sambotSocket || "") {
  let back = false;
  socket = new Socket(address, {
    take: (part) => {
      if (part.picture) pictures.take(part.picture);
      else if (part.of === "camera") {
        // A follower does not know that the page has a camera already, and keeps it.
        takeCamera(back && rows.data(FOLLOWS) ? { ...part, camera: null } : part);
        back = false;
      } else rows.take(part.of, part);
    },
    lost: () => {
      back = true;
      loseCamera();
      // Who hears it notes how things were, and holds edits back.
      rows.notify(CUT);
    },
    removed: () => rows.notify(REMOVED),
    stops: () => rows.notify(STOPS),
  });
  reportCamera((report) => socket?.send(report));
}

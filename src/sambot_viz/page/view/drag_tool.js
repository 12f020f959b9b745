// @ts-check
/* A tool that draws with a drag, such as the arrow of a goal: the server is told where the button
 * went down, where the pointer is, and where it was released. The view stays meanwhile. */

import { act, DRAG, newGesture, rows, send } from "../wire/channel.js";
import { focusView, placeIn } from "./pointer.js";

/** At most so many places are sent in a second. */
const PLACES = 20;

/** The pointer that draws, its gesture, and where that began.
 * @type {{id: number, gesture: any, begin: [number, number]} | null} */
let drawn = null;
/** The place that waits to be sent. @type {[number, number] | null} */
let waiting = null;
let timer = 0;

const isWanted = () =>
  Boolean(rows.data("tools/list")?.some((/** @type {any} */ tool) => tool.current && tool.drags));

function tell() {
  timer = 0;
  if (!drawn || !waiting) return;
  send(DRAG, [...drawn.begin, ...waiting], drawn.gesture);
  waiting = null;
  timer = window.setTimeout(tell, 1000 / PLACES);
}

/** End the drag. @param {PointerEvent | null} event where it was released; null stops it */
function end(event) {
  clearTimeout(timer);
  timer = 0;
  const place = event && placeIn(event);
  const begin = drawn?.begin ?? [];
  drawn = waiting = null;
  if (place) act("tools/drop", [...begin, ...place]);
  else act("tools/right_click");
}

/** Stop what is drawn, without its effect. */
export function stopDrawing() {
  if (drawn) end(null);
}

/** @param {PointerEvent} event */
function press(event) {
  // Another button or a second finger stops it.
  if (drawn) return end(null);
  const place = event.button === 0 && isWanted() ? placeIn(event) : null;
  if (!place) return;
  event.stopImmediatePropagation();
  focusView();
  drawn = { id: event.pointerId, gesture: newGesture(), begin: place };
  waiting = place;
  tell();
}

/** @param {PointerEvent} event */
function move(event) {
  if (drawn?.id !== event.pointerId) return;
  event.stopImmediatePropagation();
  // The button was released where this page does not hear of it.
  if (!event.buttons) return end(null);
  waiting = placeIn(event) ?? waiting;
  if (!timer) tell();
}

/** @param {PointerEvent} event */
function release(event) {
  if (drawn?.id !== event.pointerId) return;
  event.stopImmediatePropagation();
  end(event.type === "pointerup" ? event : null);
}

// Before the scripts that turn the camera.
if (globalThis.window) {
  addEventListener("pointerdown", press, true);
  addEventListener("pointermove", move, true);
  addEventListener("pointerup", release, true);
  addEventListener("pointercancel", release, true);
}

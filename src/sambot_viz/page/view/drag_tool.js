// @ts-check
/* A drag that belongs to the tool, such as the arrow of a goal or the handle of a marker: the
 * server is told where the button went down, where the pointer is, and where it was released. The
 * view stays meanwhile.
 *
 * Of a tool that takes handles a press is a drag where the server has said so of that place. Of a
 * place that the mouse has not rested on, and of a finger, it is asked first; a press that is none
 * is given to the view then. */

import { act, DRAG, HOVER, newGesture, rows, send } from "../wire/channel.js";
import { focusView, placeIn } from "./pointer.js";

/** Maximum number of places sent in a second. */
const PLACES = 20;
/** So near to a place that was asked about a press is there, by the size of the view. */
const NEAR = 0.003;
/** So long a press waits to be told whether it is a drag [ms]. */
const PATIENCE = 3000;
/** A finger that rests so long on a handle asks for its menu [ms]. */
const REST = 700;
/** A finger that moves less has not moved [px]. */
const STILL = 8;

/** The pointer that draws, its gesture, and where that began.
 * @type {{id: number, gesture: any, begin: [number, number], x: number, y: number} | null} */
let drawn = null;
/** What waits to be sent: the place, and a key that is held.
 * @type {[number, number, string | null] | null} */
let waiting = null;
let timer = 0;
let rest = 0;

/** A press that waits to be told whether it is a drag, with what came after it.
 * @type {{events: PointerEvent[], place: [number, number], timer: number} | null} */
let asked = null;
/** What is given to the view. @type {WeakSet<Event>} */
const given = new WeakSet();

/** @returns {any} */
const currentTool = () => rows.data("tools/list")?.find((/** @type {any} */ tool) => tool.current);

/** The key that counts. @param {PointerEvent} event */
const heldKey = (event) =>
  event.shiftKey ? "shift" : event.ctrlKey || event.metaKey ? "cmd/ctrl" : null;

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
  clearTimeout(rest);
  timer = 0;
  const place = event && placeIn(event);
  const begin = drawn?.begin ?? [];
  drawn = waiting = null;
  if (event && place) act("tools/drop", [...begin, ...place, heldKey(event)]);
  else act("tools/right_click");
}

/** Stop what is drawn, without its effect. */
export function stopDrawing() {
  if (drawn) end(null);
}

/** Begin a drag. @param {PointerEvent} event @param {[number, number]} place */
function begin(event, place) {
  focusView();
  const { pointerId: id, clientX: x, clientY: y } = event;
  drawn = { id, gesture: newGesture(), begin: place, x, y };
  waiting = [...place, heldKey(event)];
  tell();
  if (event.pointerType === "touch" && currentTool()?.handles)
    rest = window.setTimeout(() => {
      end(null);
      act("tools/open_menu");
    }, REST);
}

/** Whether the server has said of a place what a press there is; undefined while it has not.
 * @param {[number, number]} place @returns {boolean | undefined} */
function holdsAt([x, y]) {
  const over = rows.data("tools/over");
  if (!over || Math.hypot(over.x - x, over.y - y) > NEAR) return undefined;
  return over.holds;
}

/** Wait for what the server says of a press. @param {PointerEvent} event
 * @param {[number, number]} place */
function ask(event, place) {
  const timer = window.setTimeout(() => answer(false), PATIENCE);
  asked = { events: [event], place, timer };
  send(HOVER, place, newGesture());
}

/** What waited is a drag, or is given to the view. @param {boolean} holds */
function answer(holds) {
  if (!asked) return;
  const { events, place, timer } = asked;
  clearTimeout(timer);
  asked = null;
  if (holds) {
    begin(events[0], place);
    for (const event of events.slice(1)) follow(event);
    return;
  }
  for (const event of events) {
    const copy = new PointerEvent(event.type, event);
    given.add(copy);
    event.target?.dispatchEvent(copy);
  }
}

/** @param {PointerEvent} event */
function press(event) {
  if (given.has(event)) return;
  // Another button or a second finger stops it.
  if (drawn) return end(null);
  if (asked) return answer(false);
  const place = event.button === 0 ? placeIn(event) : null;
  const tool = currentTool();
  if (!place || !(tool?.drags || (tool?.handles && tool.hover))) return;
  const holds = tool.drags || holdsAt(place);
  if (holds === false) return;
  event.stopImmediatePropagation();
  if (holds) begin(event, place);
  else ask(event, place);
}

/** A move or the end of a drag. @param {PointerEvent} event */
function follow(event) {
  if (event.type !== "pointermove") return end(event.type === "pointerup" ? event : null);
  // The button was released where this page does not hear of it.
  if (!event.buttons) return end(null);
  if (drawn && Math.hypot(event.clientX - drawn.x, event.clientY - drawn.y) > STILL)
    clearTimeout(rest);
  const place = placeIn(event);
  if (place) waiting = [...place, heldKey(event)];
  if (!timer) tell();
}

/** @param {PointerEvent} event */
function later(event) {
  if (given.has(event)) return;
  if (asked?.events[0].pointerId === event.pointerId) asked.events.push(event);
  else if (drawn?.id === event.pointerId) follow(event);
  else return;
  event.stopImmediatePropagation();
}

// Before the scripts that turn the camera.
if (globalThis.window) {
  addEventListener("pointerdown", press, true);
  for (const kind of ["pointermove", "pointerup", "pointercancel"])
    addEventListener(kind, /** @type {(event: Event) => void} */ (later), true);
  rows.listen("tools/over", () => {
    const holds = asked && holdsAt(asked.place);
    if (typeof holds === "boolean") answer(holds);
  });
}

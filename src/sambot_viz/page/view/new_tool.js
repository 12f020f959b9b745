// @ts-check
/* A tool that was just chosen has the mouse at once. The server switches tools, and tells viser
 * what the new one uses of the mouse; what is pressed before that has arrived would be for the
 * tool before. So it waits here, and is done then. */

import { act, rows } from "../wire/channel.js";
import { Cell } from "../state.js";
import { followMessages } from "./messages.js";

/** @typedef {{name: string, current: boolean, first: boolean, clicks: boolean, rectangles: boolean}} Tool */

/** So long a press waits at most: there may be no server [ms]. */
const PATIENCE = 3000;
const EVENTS = ["pointerdown", "pointermove", "pointerup", "pointercancel"];

/** The tool that was chosen and is not there yet. @type {Cell<string | null>} */
export const newTool = new Cell(/** @type {string | null} */ (null));
/** What viser uses of the mouse now. @type {Record<string, boolean>} */
const used = { click: false, "rect-select": false };
/** What waits. @type {PointerEvent[]} */
let held = [];
let again = false;
let timer = 0;

/** @returns {Tool[]} */
const tools = () => rows.data("tools/list") || [];

/** Call a command; a tool that it makes the current one has the mouse from now on.
 * @param {string} id @param {any[]} [args] */
export function actAtOnce(id, args = []) {
  if (["tools/choose", "tools/press", "tools/escape"].includes(id) && rows.can(id))
    expect(id, args);
  act(id, args);
}

/** @param {string} id @param {any[]} args */
function expect(id, args) {
  const list = tools(),
    current = newTool.value ?? list.find((tool) => tool.current)?.name,
    first = list.find((tool) => tool.first)?.name;
  const leaves = id === "tools/escape" || (id === "tools/press" && args[0] === current);
  const name = leaves ? first : args[0];
  newTool.set(name ?? null);
  clearTimeout(timer);
  timer = window.setTimeout(arrive, PATIENCE);
  look();
}

/** Whether the new tool has all that it needs. */
function look() {
  const tool = tools().find((one) => one.name === newTool.value);
  if (!tool?.current) return;
  const { clicks, rectangles } = tool;
  // In a page without a view nothing more is to come.
  if (!window.__viserMutable || (used.click === clicks && used["rect-select"] === rectangles))
    arrive();
}

/** Let the new tool have what waited for it. */
function arrive() {
  clearTimeout(timer);
  newTool.set(null);
  const events = held;
  held = [];
  again = true;
  for (const event of events) event.target?.dispatchEvent(new PointerEvent(event.type, event));
  again = false;
}

/** @param {PointerEvent} event */
function hold(event) {
  const begins = event.type === "pointerdown" && event.target === window.__viserMutable?.canvas;
  const waits = held.some(({ pointerId }) => pointerId === event.pointerId);
  if (again || newTool.value === null || !event.isTrusted || !(begins || waits)) return;
  event.stopImmediatePropagation();
  held.push(event);
}

/** Notice what viser is told to use of the mouse. @param {any[]} taken */
function notice(taken) {
  const told = taken.filter((message) => message.type === "ScenePointerEnableMessage");
  for (const { event_type, modifiers } of told) used[event_type] = modifiers.length > 0;
  // What was taken is done when this picture is drawn.
  if (told.length) setTimeout(look);
}

// Before the scripts that follow the mouse.
for (const type of globalThis.window ? EVENTS : [])
  addEventListener(type, (event) => hold(/** @type {PointerEvent} */ (event)), true);
rows.listen("tools/list", look);
followMessages(notice);

// @ts-check
/* The order of displays: which places there are, and how a hand takes a display there. */

import { act, rows } from "../wire/channel.js";
import { isOpen } from "../state.js";

/** @typedef {import("../wire/rows.js").Row} Row */
/**
 * A place between displays.
 * @typedef {{group: string, index: number}} Place
 *   group: the id of the group, "" at the top; index: counted without the display that goes there
 * @typedef {Place & {y: number, depth: number, into?: string}} Line where a place is drawn
 *   into: the id of the group's row, when the display goes into a folded group
 */

const TOP = "";

/** The displays in a group, or at the top. @param {string} group @returns {string[]} */
export function members(group) {
  return rows.children(group || "panel:displays").filter((id) => rows.get(id)?.display);
}

/**
 * What is selected after a display has been removed.
 * @param {Row} display
 * @returns {string | undefined}
 */
export function neighbour(display) {
  const all = members(display.in);
  const at = all.indexOf(display.id);
  return all[at + 1] ?? all[at - 1] ?? (display.in || undefined);
}

/** The place one up or down, into open groups and out of them; null at the ends.
 * @param {Row} display @param {number} by 1 or -1 @returns {Place | null} */
export function place(display, by) {
  const all = members(display.in);
  const at = all.indexOf(display.id);
  const beside = rows.get(all[at + by]);
  if (beside?.group && isOpen(beside.id)) {
    return { group: beside.id, index: by > 0 ? 0 : members(beside.id).length };
  }
  if (beside) return { group: display.in, index: at + by };
  const group = rows.get(display.in);
  if (!group) return null;
  return { group: group.in, index: members(group.in).indexOf(group.id) + (by > 0 ? 1 : 0) };
}

/** Keys come faster than answers: these steps wait until those before are done.
 * @type {[string, number][]} */
let steps = [];
/** After a step that is not done in so long [ms], the others are not wanted any more. */
const LONGEST_STEP = 10000;

/** One place up or down, also into an open group and out of it.
 * @param {string} id of the display @param {number} by 1 or -1 */
export function moveBy(id, by) {
  if (steps.push([id, by]) === 1) step();
}

function step() {
  const [id, by] = steps[0];
  const display = rows.get(id);
  const to = display && place(display, by);
  if (!to) {
    steps = [];
    return;
  }
  const stop = rows.listen("panel:displays", () => {
    if (members(to.group)[to.index] === id) done();
  });
  const timer = setTimeout(() => {
    stop();
    steps = [];
  }, LONGEST_STEP);
  const done = () => {
    stop();
    clearTimeout(timer);
    steps.shift();
    if (steps.length) step();
  };
  act("displays/move", [id, to.group, to.index]);
}

/**
 * All places where a display can go, with the line at which each is drawn.
 * @param {string} moved the id of the display
 * @param {(id: string) => {top: number, bottom: number} | null} box where the row of an id is drawn
 * @returns {Line[]}
 */
export function places(moved, box) {
  /** @type {Line[]} */
  const found = [];
  /** The lower end of a row and all that is shown below it. @param {string} id @returns {number} */
  const end = (id) => {
    const last = isOpen(id)
      ? rows
          .children(id)
          .filter((child) => box(child))
          .at(-1)
      : undefined;
    return last ? end(last) : (box(id)?.bottom ?? 0);
  };
  /** @param {string} group @param {number} depth */
  const walk = (group, depth) => {
    const others = members(group).filter((id) => id !== moved);
    others.forEach((id, index) => {
      const row = rows.get(id);
      const at = box(id);
      if (!row || !at) return;
      found.push({ group, index, y: at.top, depth });
      if (row.group && isOpen(id)) walk(id, depth + 1);
      else if (row.group)
        found.push({
          group: id,
          index: members(id).length,
          y: (at.top + at.bottom) / 2,
          depth: depth + 1,
          into: id,
        });
      if (index === others.length - 1) found.push({ group, index: index + 1, y: end(id), depth });
    });
    if (!others.length && group) found.push({ group, index: 0, y: box(group)?.bottom ?? 0, depth });
  };
  walk(TOP, 0);
  return found;
}

/** The place that a hand means. Of places at one line, those further right are deeper.
 * @template {{y: number, depth: number}} P
 * @param {P[]} all @param {number} x from the left edge of the names [px] @param {number} y @param
 *   {number} indent of one level [px]
 * @returns {P | undefined} */
export function nearest(all, x, y, indent) {
  const depth = Math.floor(x / indent);
  const off = (/** @type {P} */ p) => Math.abs(p.y - y) + 0.1 * Math.abs(p.depth - depth);
  return all.reduce(
    (/** @type {P | undefined} */ best, p) => (best && off(best) <= off(p) ? best : p),
    undefined,
  );
}

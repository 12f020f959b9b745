// @ts-check
/* The element of a row: what it says of itself, whether or not the row is drawn whole. */

import { rows } from "../wire/channel.js";

/** @typedef {import("../wire/rows.js").Row} Row */
/**
 * What a row is drawn from, beside itself.
 * @typedef {{depth: number, opens: boolean, open: boolean, current: boolean, chosen: boolean,
 *   renaming: boolean, hover: boolean, row: number, place: number, of: number}} Facts
 *   opens: whether rows are below it; current: whether the Tab key stops here; hover: whether its
 *   help is shown on hover; row: its number in the tree; place and of: which it is of how many below
 *   the same row
 */

/** Why a viewer's controls are grey. */
const VIEW_ONLY = "View only: request control to change it";
/** A status, or another sentence, that is longer is below its name, over the whole width. */
const BESIDE = 24;
/** Kinds of rows that are one line high, whatever they hold. */
const LINES = new Set(
  "slider group bool int float text file frame color vector enum display".split(" "),
);

/** A name without a value beside it has the whole width. @param {Row} row */
export const alone = (row) => row.kind === "group" || row.whole;

/** Whether the whole width is one text. @param {Row} row */
export const isWide = (row) => row.kind === "note" || row.kind === "lines";

/**
 * Whether a row is one line high: then it can be left undrawn while it is out of sight.
 * @param {Row} row
 */
export function isPlain(row) {
  if (LINES.has(row.kind)) return true;
  const said = row.kind === "status" || row.kind === "readonly";
  return (
    said &&
    String(row.value).length <= BESIDE &&
    !row.copy &&
    !row.repair &&
    !row.leads &&
    !row.wraps
  );
}

/** The classes of a row. @param {Row} row */
function classes(row) {
  const list = ["row", `k-${row.kind}`, `l-${row.level || "none"}`];
  const wraps = row.kind === "status" || row.wraps;
  const long = wraps && String(row.value).length > BESIDE;
  const states = { bold: row.bold, off: row.off, unticked: row.value === false, alone: alone(row) };
  for (const [name, on] of Object.entries({ ...states, long })) if (on) list.push(name);
  return list;
}

/** The classes that an element has of its row. @type {WeakMap<HTMLElement, string[]>} */
const given = new WeakMap();

/**
 * Bring the element of a row up to date.
 * @param {HTMLElement} element @param {Row} row @param {Facts} facts
 */
export function dress(element, row, facts) {
  const { depth, opens, open, current, chosen, hover } = facts;
  const before = given.get(element) || [];
  const now = classes(row);
  if (String(before) !== String(now)) {
    // Others may have marked it, as what is dragged.
    element.classList.remove(...before);
    element.classList.add(...now);
    given.set(element, now);
  }
  const locked = row.off && rows.watching ? VIEW_ONLY : undefined;
  // The panel Joints has a place for the help of a joint.
  const joint = row.kind === "slider" && row.low === undefined;
  const help = hover && !isWide(row) && !joint ? row.help : undefined;
  set(element, "tabindex", current ? "0" : "-1");
  set(element, "title", locked || help);
  set(element, "aria-level", String(depth + 1));
  // The others may have no elements.
  set(element, "aria-rowindex", String(facts.row));
  set(element, "aria-posinset", String(facts.place));
  set(element, "aria-setsize", String(facts.of));
  set(element, "aria-expanded", opens ? String(open) : undefined);
  set(element, "aria-selected", String(chosen));
  element.style.setProperty("--depth", String(depth));
}

/** @param {HTMLElement} element @param {string} name @param {string | undefined} value */
export function set(element, name, value) {
  if (value === undefined) element.removeAttribute(name);
  else if (element.getAttribute(name) !== value) element.setAttribute(name, value);
}

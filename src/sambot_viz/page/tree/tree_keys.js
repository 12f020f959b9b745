// @ts-check
/* The keys of a tree grid, on the row that is selected. */

import { mayChange, rows, send } from "../wire/channel.js";
import { fold, isOpen } from "../state.js";
import { copyRow } from "./row_text.js";
import { edits } from "./row_view.js";

/** @typedef {import("../wire/rows.js").Row} Row */
/**
 * @typedef {{ids: string[], current: string | undefined, led?: string,
 *   go: (id: string | undefined) => void,
 *   openMenu: (event: Key, row: Row) => void,
 *   onKey?: (event: Key, row: Row) => boolean | void}} KeyedTree
 *   ids: of the rows that are shown; onKey: the keys of the panel; led: the row that the user was
 *   led to, or has accepted the text of, and has not touched since: only Enter and F2 begin to edit
 *   it, other keys are for tools
 */

const FAR = 10;
/** @type {Record<string, (at: number, last: number) => number>} */
const MOVES = {
  ArrowDown: (at) => at + 1,
  ArrowUp: (at) => at - 1,
  PageDown: (at, last) => Math.min(last, at + FAR),
  PageUp: (at) => Math.max(0, at - FAR),
  Home: () => 0,
  End: (_, last) => last,
};

/** @param {string} id */
export function canOpen(id) {
  return rows.children(id).length > 0 || Boolean(rows.get(id)?.lazy);
}

/** Act on a key in a tree. @param {Key} event @param {KeyedTree} tree */
export function treeKey(event, tree) {
  const row = tree.current && rows.get(tree.current);
  if (!row) return;
  /** @type {boolean | void | "types"} */
  let used;
  if (!event.target.matches?.("input:not([type=checkbox]), select, textarea"))
    used = tree.onKey?.(event, row) || keyOnRow(event, row, tree);
  else if (event.key === "Escape") {
    used = true;
    tree.go(tree.current);
  }
  if (!used) return;
  if (used !== "types") event.preventDefault();
  event.stopPropagation();
}

/**
 * @param {Key} event
 * @param {Row} row
 * @param {KeyedTree} tree
 * @returns {boolean | "types"} whether the key is used, or goes into a field
 */
function keyOnRow(event, row, tree) {
  const { ids, go } = tree;
  const open = canOpen(row.id) && isOpen(row.id);
  const at = ids.indexOf(row.id);
  if (event.ctrlKey || event.metaKey) {
    if (event.key.toLowerCase() !== "c" || String(getSelection())) return false;
    copyRow(row);
  } else if (event.altKey) return false;
  else if (event.key === "ContextMenu" || (event.shiftKey && event.key === "F10"))
    tree.openMenu(event, row);
  else if (event.key in MOVES) go(ids[MOVES[event.key](at, ids.length - 1)]);
  else if (event.key === "ArrowRight") {
    if (canOpen(row.id) && !open) fold(row.id, true);
    else if (open) go(ids[at + 1]);
  } else if (event.key === "ArrowLeft") {
    if (open) fold(row.id, false);
    else go(row.in);
  } else if (event.target.dataset?.row !== row.id) return false;
  else return changeByKey(event, row, tree.led !== row.id);
  return true;
}

/** Toggle, edit, or begin to type. @param {Key} event @param {Row} row @param {boolean} types */
function changeByKey(event, row, types) {
  if (event.key === " " && typeof row.value === "boolean") toggle(row);
  else if (event.key === "Enter" || event.key === "F2") edit(event, row);
  else if (types && edits(row, event.key)) {
    /** @type {HTMLElement | null} */ (event.target.querySelector("input.field"))?.focus();
    return "types";
  } else if (types && rows.watching && edits({ ...row, off: false }, event.key)) {
    // What was meant for the value is no key of a tool or a view.
    mayChange();
  } else return false;
  return true;
}

/** @param {Row} row */
function toggle(row) {
  if (!row.fixed && !row.off) send(row.id, !row.value);
}

/** What Enter does: edit, else toggle or fold. @param {Key} event @param {Row} row */
function edit(event, row) {
  /** @type {HTMLInputElement | HTMLSelectElement | null} */
  const field = event.target.querySelector("input:not([type=checkbox]):not([type=color]), select");
  if (field && !field.disabled) field.focus();
  else if (canOpen(row.id)) fold(row.id, !isOpen(row.id));
  else if (typeof row.value === "boolean") toggle(row);
}

// @ts-check
/* A panel's rows as RViz's property tree: a tree grid with the keys of one. */

import { html, useLayoutEffect, useRef, useState } from "../vendor/preact.js";
import { act, ONLINE, rows, send } from "../wire/channel.js";
import { copy } from "../window/clipboard.js";
import { isTyping } from "../window/keys.js";
import { Menu } from "../window/menu.js";
import { RowList } from "./row_list.js";
import { copyText, valueText } from "./row_text.js";
import { edits, RowView } from "./row_view.js";
import { Cell, fold, folds, isOpen, select, selected, splits, useRow } from "../state.js";

/** @typedef {import("../wire/rows.js").Row} Row */
/** @typedef {import("../window/menu.js").Item} Item */

/**
 * Rows of longer lists are only laid out near the screen; a screen reader knows their names then.
 */
const MANY = 150;

/** The width of the names before a hand has moved the line, as a part of the panel. */
const SPLIT = 0.6;
/** The row that is scrolled to, and gets the focus, as soon as it is there.
 * @type {Cell<{panel: string, id: string, focus: boolean} | null>} */
const wantedFocus = new Cell(
  /** @type {{panel: string, id: string, focus: boolean} | null} */ (null),
);

/** The ids of the rows that are unfolded, with their depth, in order.
 * @param {string} panel @param {(row: Row) => boolean} [wanted] a search: only rows it finds */
export function visible(panel, wanted) {
  /** @type {{id: string, depth: number}[]} */
  const found = [];
  /** @param {string} key @param {number} depth */
  const walk = (key, depth) => {
    for (const id of rows.children(key)) {
      const row = rows.get(id);
      if (!row || row.apart) continue;
      const inside = rows.children(id).length > 0;
      if (!wanted || wanted(row)) found.push({ id, depth });
      if (inside && (wanted || isOpen(id))) walk(id, depth + 1);
    }
  };
  walk(`panel:${panel}`, 0);
  return found;
}

/** @param {string} id */
export function canOpen(id) {
  return rows.children(id).length > 0 || Boolean(rows.get(id)?.lazy);
}

/** Select a row, unfold what is above it, and give it the focus.
 * @param {string} panel
 * @param {string} id
 * @param {boolean} [focus] false: the focus stays where it is
 */
export function reveal(panel, id, focus = true) {
  for (let above = rows.get(id)?.in; above; above = rows.get(above)?.in) fold(above, true);
  select(panel, id);
  wantedFocus.set({ panel, id, focus });
}

/** All rows below one. @param {string} id @returns {Row[]} */
function allBelow(id) {
  return rows
    .children(id)
    .flatMap((child) => [/** @type {Row} */ (rows.get(child)), ...allBelow(child)]);
}

/** @param {Row} row */
function copyRow(row) {
  const one = row.kind === "status" ? "the status" : valueText(row) ? "the value" : "the name";
  copy(copyText(row, allBelow(row.id)), one);
}

/**
 * @param {{panel: string, label: string, wanted?: (row: Row) => boolean, split?: boolean, hover?:
 *   boolean,
 *   onKey?: (event: KeyboardEvent, row: Row) => boolean | void, menu?: (row: Row) => Item[],
 *   onDouble?: (row: Row) => boolean,
 *   renaming?: string, rename?: (id: string, name: string | null) => void,
 *   drag?: (event: any, row: Row, tree: HTMLElement) => void}} props
 *   onKey: keys of the panel on the selected row; it returns whether it used the key
 *   onDouble: what a double click does; it returns whether it did anything
 *   menu: what the context menu offers above copying
 *   split: whether the width of the names can be moved
 *   hover: whether the help of a row is shown on hover
 */
export function Tree({
  panel,
  label,
  wanted,
  split = panel !== "joints",
  hover = true,
  onKey,
  onDouble,
  menu,
  renaming,
  rename,
  drag,
}) {
  useRow(`panel:${panel}`);
  folds.use();
  const chosen = selected.use()[panel];
  const focus = wantedFocus.use();
  const ratio = splits.use()[panel] ?? SPLIT;
  const element = useRef(/** @type {any} */ (null));
  const [opened, setOpened] = useState(
    /** @type {{row: Row, at: {x: number, y: number}} | null} */ (null),
  );
  const shown = visible(panel, wanted);
  const current = shown.some(({ id }) => id === chosen) ? chosen : shown[0]?.id;
  const list = useRef(/** @type {RowList | null} */ (null));

  /** @param {string | undefined} id @returns {HTMLElement | null} */
  const find = (id) =>
    id ? element.current?.querySelector(`[data-row="${CSS.escape(id)}"]`) : null;
  /** @param {string | undefined} id */
  const go = (id) => {
    if (!id) return;
    select(panel, id);
    const row = find(id);
    row?.focus();
    row?.scrollIntoView({ block: "nearest" });
  };
  /** @param {any} event @param {Row} row */
  const openMenu = (event, row) => {
    event.preventDefault();
    const box = event.target.getBoundingClientRect();
    const byMouse = event.type === "contextmenu" && (event.clientX || event.clientY);
    go(row.id);
    setOpened({
      row,
      at: byMouse ? { x: event.clientX, y: event.clientY } : { x: box.left + 40, y: box.bottom },
    });
  };
  /** @param {any} event */
  const key = (event) => {
    const row = current && rows.get(current);
    if (!row) return;
    const used = event.target.matches?.("input:not([type=checkbox]), select, textarea")
      ? event.key === "Escape" && (go(current), true)
      : onKey?.(event, row) || keyOnRow(event, row);
    if (!used) return;
    if (used !== "types") event.preventDefault();
    event.stopPropagation();
  };
  /**
   * @param {any} event
   * @param {Row} row
   * @returns {boolean | "types"} whether the key is used, or goes into a field
   */
  const keyOnRow = (event, row) => {
    const at = shown.findIndex(({ id }) => id === current);
    const onRow = event.target.dataset?.row === current;
    const open = canOpen(row.id) && isOpen(row.id);
    if (event.ctrlKey || event.metaKey) {
      if (event.key.toLowerCase() !== "c" || String(getSelection())) return false;
      copyRow(row);
    } else if (event.altKey) return false;
    else if (event.key === "ContextMenu" || (event.shiftKey && event.key === "F10"))
      openMenu(event, row);
    else if (event.key === "ArrowDown") go(shown[at + 1]?.id);
    else if (event.key === "ArrowUp") go(shown[at - 1]?.id);
    else if (event.key === "PageDown") go(shown[Math.min(shown.length - 1, at + 10)]?.id);
    else if (event.key === "PageUp") go(shown[Math.max(0, at - 10)]?.id);
    else if (event.key === "Home") go(shown[0]?.id);
    else if (event.key === "End") go(shown[shown.length - 1]?.id);
    else if (event.key === "ArrowRight") {
      if (canOpen(row.id) && !open) fold(row.id, true);
      else if (open) go(shown[at + 1]?.id);
    } else if (event.key === "ArrowLeft") {
      if (open) fold(row.id, false);
      else go(row.in);
    } else if (!onRow) return false;
    else if (event.key === " " && typeof row.value === "boolean") {
      if (!row.fixed && !row.off) send(row.id, !row.value);
    } else if (event.key === "Enter" || event.key === "F2") edit(event, row);
    else if (edits(row, event.key)) {
      event.target.querySelector("input.field")?.focus();
      return "types";
    } else return false;
    return true;
  };
  /** What Enter does: edit, else tick, else fold. @param {any} event @param {Row} row */
  const edit = (event, row) => {
    const field = event.target.querySelector(
      "input:not([type=checkbox]):not([type=color]), select",
    );
    if (field && !field.disabled) field.focus();
    else if (canOpen(row.id)) fold(row.id, !isOpen(row.id));
    else if (typeof row.value === "boolean" && !row.fixed && !row.off) send(row.id, !row.value);
  };
  /** @param {Row} row @returns {Item[]} */
  const items = (row) => {
    const word = row.kind === "status" ? "status" : valueText(row) ? "value" : "name";
    return [
      ...(menu?.(row) || []),
      { label: `Copy ${word}`, keys: "Ctrl+C", act: () => copyRow(row) },
    ];
  };
  // Rows get the same functions all the time: only rows with other facts are drawn again.
  const api = useRef(/** @type {any} */ ({}));
  api.current = {
    panel,
    hover,
    go,
    openMenu,
    onDouble,
    rename,
    drag: (/** @type {any} */ e, /** @type {Row} */ row) => drag?.(e, row, element.current),
  };
  /** @param {{id: string, depth: number}} one @returns {import("./row_list.js").Drawn} */
  const drawn = ({ id, depth }) => {
    const opens = canOpen(id);
    const open = opens && (Boolean(wanted) || isOpen(id));
    const facts = {
      depth,
      opens,
      open,
      current: id === current,
      chosen: id === chosen,
      renaming: renaming === id,
    };
    return {
      id,
      facts: JSON.stringify(facts),
      view: () => html`<${RowView} id=${id} api=${api} ...${facts} />`,
    };
  };
  useLayoutEffect(() => {
    list.current = new RowList(element.current);
    return () => list.current?.clear();
  }, []);
  useLayoutEffect(() => list.current?.show(shown.map(drawn)));
  useLazy(panel, shown);
  useKeptFocus(panel, shown, chosen, element);
  useLayoutEffect(() => {
    const row = focus?.panel === panel && find(focus.id);
    if (!row) return;
    wantedFocus.set(null);
    // The hand that is typing elsewhere goes on.
    if (focus.focus && !isTyping(document.activeElement)) return go(focus.id);
    select(panel, focus.id);
    row.scrollIntoView({ block: "nearest" });
  });
  return html`<div class="treebox" style=${`--split: ${(ratio * 100).toFixed(1)}%`}>
    <div class=${shown.length > MANY ? "tree many" : "tree"} role="treegrid" aria-label=${label} data-panel=${panel} ref=${element} onKeyDown=${key}></div>
    ${split && html`<${Divider} panel=${panel} ratio=${ratio} />`}
    ${opened && html`<${Menu} label=${opened.row.name || label} at=${opened.at} items=${items(opened.row)} close=${() => setOpened(null)} />`}
  </div>`;
}

/** Ask for what is below open rows that have more than was sent.
 * @param {string} panel @param {{id: string}[]} shown */
function useLazy(panel, shown) {
  const asked = useRef(new Set());
  // Who answers now may not have heard what was asked before, or without a connection.
  useRow(ONLINE);
  useLayoutEffect(() => rows.listen(ONLINE, () => asked.current.clear()), []);
  useLayoutEffect(() => {
    for (const { id } of shown) {
      if (!rows.get(id)?.lazy) asked.current.delete(id);
      else if (isOpen(id) && !asked.current.has(id)) {
        asked.current.add(id);
        act(`${panel}/unfold`, [id]);
      }
    }
  });
}

/** When the selected row goes, the one in its place is selected, and gets the focus it had.
 * @param {string} panel
 * @param {{id: string}[]} shown
 * @param {string | undefined} chosen
 * @param {{current: any}} element
 */
function useKeptFocus(panel, shown, chosen, element) {
  const last = useRef({ at: -1, focused: false });
  useLayoutEffect(() => {
    const at = shown.findIndex(({ id }) => id === chosen);
    const lost = !document.activeElement || document.activeElement === document.body;
    const instead = shown[Math.min(last.current.at, shown.length - 1)]?.id;
    if (at < 0 && chosen && last.current.at >= 0 && instead && !rows.get(chosen)) {
      if (last.current.focused && lost) reveal(panel, instead);
      else select(panel, instead);
    }
    last.current = { at, focused: Boolean(element.current?.contains(document.activeElement)) };
  });
}

/**
 * The line between names and values; a hand or the arrow keys move it.
 * @param {{panel: string, ratio: number}} props
 */
function Divider({ panel, ratio }) {
  /** @param {number} to */
  const set = (to) => splits.set({ ...splits.value, [panel]: Math.min(0.85, Math.max(0.15, to)) });
  /** @param {any} event */
  const drag = (event) => {
    const box = event.target.parentElement;
    const { left } = box.getBoundingClientRect();
    event.target.setPointerCapture(event.pointerId);
    event.target.onpointermove = (/** @type {any} */ e) =>
      set((e.clientX - left) / box.clientWidth);
    event.target.onpointerup = () => {
      event.target.onpointermove = null;
    };
    event.preventDefault();
  };
  /** @param {any} event */
  const key = (event) => {
    const by = /** @type {Record<string, number>} */ ({ ArrowRight: 0.02, ArrowLeft: -0.02 })[
      event.key
    ];
    if (!by) return;
    set(ratio + by);
    event.preventDefault();
    event.stopPropagation();
  };
  return html`<div class="divider" role="separator" tabindex="0" aria-orientation="vertical" aria-label="Width of the names"
    aria-valuenow=${Math.round(ratio * 100)} aria-valuemin="15" aria-valuemax="85"
    onPointerDown=${drag} onKeyDown=${key}></div>`;
}

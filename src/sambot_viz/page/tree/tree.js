// @ts-check
/* A panel's rows as RViz's property tree: a tree grid with the keys of one. */

import { html, useLayoutEffect, useRef, useState } from "../vendor/preact.js";
import { act, ONLINE, rows } from "../wire/channel.js";
import { ACCEPTED } from "../cells/field.js";
import { isTyping } from "../window/keys.js";
import { Menu } from "../window/menu.js";
import { refusals } from "../window/notices.js";
import { Divider } from "./divider.js";
import { RowList, rowElement } from "./row_list.js";
import { copyRow, valueText } from "./row_text.js";
import { useRowMouse } from "./row_mouse.js";
import { RowView } from "./row_view.js";
import { search, useSearch } from "./search.js";
import { canOpen, treeKey } from "./tree_keys.js";
import { Cell, fold, folds, isOpen, select, selected, splits, useRow } from "../state.js";

/** @typedef {import("../wire/rows.js").Row} Row */
/** @typedef {import("../window/menu.js").Item} Item */
/** @typedef {import("../window/menu.js").Place} Place */
/** @typedef {import("./row_mouse.js").TreeApi} TreeApi */
/** @typedef {import("./row_element.js").Facts} Facts */
/** @typedef {{id: string, depth: number, open: boolean}[]} Shown open: rows below it are shown */

/** The width of the names before a hand has moved the line, as a part of the panel. */
const SPLIT = 0.6;
/** The row that is scrolled to, and gets the focus, as soon as it is there.
 * @type {Cell<{panel: string, id: string, focus: boolean} | null>} */
const wantedFocus = new Cell(
  /** @type {{panel: string, id: string, focus: boolean} | null} */ (null),
);

/** The rows that are shown, in order: below unfolded ones; in a search what is found, what is above
 * it, and what is unfolded below it.
 * @param {string} panel @param {(row: Row) => boolean} [wanted] whether a search finds a row */
export function visible(panel, wanted) {
  /** @type {Shown} */
  const shown = [];
  /** @param {string} key @param {number} depth @param {boolean} all whether each row is shown */
  const walk = (key, depth, all) => {
    for (const id of rows.children(key)) {
      const row = rows.get(id);
      if (!row || row.apart) continue;
      const found = all || Boolean(wanted?.(row));
      const at = shown.push({ id, depth, open: isOpen(id) });
      if (wanted || isOpen(id)) walk(id, depth + 1, found && isOpen(id));
      if (shown.length > at) shown[at - 1].open = true;
      else if (!found) shown.pop();
    }
  };
  walk(`panel:${panel}`, 0, !wanted);
  return shown;
}

/** Select a row, unfold what is above it, and give it the focus.
 * @param {string} panel
 * @param {string} id
 * @param {boolean} [focus] false: the focus stays where it is
 */
export function reveal(panel, id, focus = true) {
  for (let above = rows.get(id)?.in; above; above = rows.get(above)?.in) fold(above, true);
  search(panel, "");
  select(panel, id);
  wantedFocus.set({ panel, id, focus });
}

/** Whether trees are drawn at all. */
let drawn = true;

/** Draw panels without their rows. @param {() => void} draw */
export function withoutRows(draw) {
  drawn = false;
  draw();
  drawn = true;
}

/** @param {any} props as those of `RowTree` */
export const Tree = (props) => drawn && html`<${RowTree} ...${props} />`;

/**
 * @param {{panel: string, label: string, finds?: (row: Row) => boolean, split?: boolean,
 *   hover?: boolean, onKey?: (event: Key, row: Row) => boolean | void,
 *   menu?: (row: Row) => Item[], onDouble?: (row: Row) => boolean, renaming?: string,
 *   rename?: (id: string, name: string | null) => void,
 *   drag?: (event: Press, row: Row, tree: HTMLElement) => void}} props
 *   finds: the rows that a search looks for
 *   onKey: keys of the panel on the selected row; it returns whether it used the key
 *   onDouble: what a double click does; it returns whether it did anything
 *   menu: what the context menu offers above copying
 *   split: whether the width of the names can be moved
 *   hover: whether the help of a row is shown on hover
 */
function RowTree(props) {
  const { panel, label, finds, split = panel !== "joints", hover = true } = props;
  const wanted = useSearch(panel, finds);
  useRow(`panel:${panel}`);
  folds.use();
  const chosen = selected.use()[panel];
  const ratio = splits.use()[panel] ?? SPLIT;
  /** @type {Ref} */
  const element = useRef(null);
  const [opened, setOpened] = useState(/** @type {{row: Row, at: Place} | null} */ (null));
  const shown = visible(panel, wanted);
  const current = shown.some(({ id }) => id === chosen) ? chosen : shown[0]?.id;
  /** The row that `reveal` has led to, or whose text Enter has accepted, until it is touched. */
  const led = useRef("");

  /** @param {string | undefined} id */
  const go = (id) => {
    if (!id) return;
    led.current = "";
    select(panel, id);
    const row = rowElement(element.current, id);
    row?.focus();
    row?.scrollIntoView({ block: "nearest" });
  };
  /** @param {Press | Key} event @param {Row} row */
  const openMenu = (event, row) => {
    event.preventDefault();
    go(row.id);
    setOpened({ row, at: menuPlace(event) });
  };
  // Rows get the same functions all the time: only rows with other facts are drawn again.
  /** @type {{current: TreeApi}} */
  const api = useRef(/** @type {any} */ (null));
  const { onDouble, rename } = props;
  /** @type {TreeApi["drag"]} */
  const drag = (event, row) => props.drag?.(event, row, element.current);
  api.current = { panel, go, openMenu, onDouble, rename, drag };
  const list = useRowList(element, shown, api, (id, isOpened) => {
    const opens = canOpen(id);
    const open = opens && isOpened;
    const renaming = props.renaming === id;
    return { opens, open, current: id === current, chosen: id === chosen, renaming, hover };
  });
  const mouse = useRowMouse(
    api,
    (id) => list.current?.touch(id),
    (id) => list.current?.press(id),
  );
  useLazy(panel, shown);
  useKeptFocus(panel, shown, chosen, element);
  useWantedFocus(panel, element, (id) => {
    go(id);
    led.current = id;
  });
  useLayoutEffect(() => {
    /** @param {any} event */
    const accepted = (event) => (led.current = event.detail);
    element.current.addEventListener(ACCEPTED, accepted);
    return () => element.current?.removeEventListener(ACCEPTED, accepted);
  }, []);
  const { onKey } = props;
  /** @param {Key} event */
  const key = (event) =>
    treeKey(event, {
      ids: shown.map(({ id }) => id),
      current,
      // What was refused is typed once more.
      led: refusals.has(led.current) ? "" : led.current,
      go,
      openMenu,
      onKey,
    });
  return html`<div class="treebox" style=${`--split: ${(ratio * 100).toFixed(1)}%`}>
    <div class="tree" role="treegrid" aria-label=${label} aria-rowcount=${shown.length}
      data-panel=${panel} ref=${element} ...${mouse} onKeyDown=${key}
      onPointerDown=${() => (led.current = "")}></div>
    ${split && html`<${Divider} panel=${panel} ratio=${ratio} />`}
    ${
      opened &&
      html`<${Menu} label=${opened.row.name || label} at=${opened.at}
        items=${menuItems(opened.row, props.menu)} close=${() => setOpened(null)} />`
    }
  </div>`;
}

/** Where the menu of a row opens: at the mouse, or below the row. @param {Press | Key} event */
function menuPlace(event) {
  const mouse = event.type === "contextmenu" ? /** @type {Press} */ (event) : null;
  if (mouse && (mouse.clientX || mouse.clientY)) return { x: mouse.clientX, y: mouse.clientY };
  const box = event.target.getBoundingClientRect();
  return { x: box.left + 40, y: box.bottom };
}

/** @param {Row} row @param {((row: Row) => Item[]) | undefined} menu @returns {Item[]} */
function menuItems(row, menu) {
  const word = row.kind === "status" ? "status" : valueText(row) ? "value" : "name";
  const copies = { label: `Copy ${word}`, keys: "Ctrl+C", act: () => copyRow(row) };
  return [...(menu?.(row) || []), copies];
}

/**
 * Draw the rows that are shown.
 * @param {Ref} element
 * @param {Shown} shown
 * @param {{current: TreeApi}} api
 * @param {(id: string, open: boolean) => Omit<Facts, "depth" | "row" | "place" | "of">} factsOf
 */
function useRowList(element, shown, api, factsOf) {
  const list = useRef(/** @type {RowList | null} */ (null));
  useLayoutEffect(() => {
    list.current = new RowList(element.current);
    return () => list.current?.clear();
  }, []);
  useLayoutEffect(() => {
    const places = placesOf(shown);
    list.current?.show(
      shown.map(({ id, depth, open }, at) => {
        const facts = { depth, row: at + 1, ...places[at], ...factsOf(id, open) };
        const view = () => html`<${RowView} id=${id} api=${api} ...${facts} />`;
        return { id, facts, view };
      }),
    );
  });
  return list;
}

/** Which each row is of how many below the same one. @param {Shown} shown */
function placesOf(shown) {
  /** Of the rows that the last one is below. @type {{count: number}[]} */
  const around = [];
  const places = shown.map(({ depth }) => {
    around.length = depth + 1;
    const below = (around[depth] ||= { count: 0 });
    return { place: (below.count += 1), below };
  });
  return places.map(({ place, below }) => ({ place, of: below.count }));
}

/**
 * Give the focus to the row for which `reveal` has asked, as soon as it is there.
 * @param {string} panel
 * @param {Ref} element
 * @param {(id: string) => void} go
 */
function useWantedFocus(panel, element, go) {
  const focus = wantedFocus.use();
  useLayoutEffect(() => {
    const row = focus?.panel === panel && rowElement(element.current, focus.id);
    if (!row) return;
    wantedFocus.set(null);
    // The hand that is typing elsewhere goes on.
    if (focus.focus && !isTyping(document.activeElement)) return go(focus.id);
    select(panel, focus.id);
    row.scrollIntoView({ block: "nearest" });
  });
}

/** Ask for what is below open rows that have more than was sent.
 * @param {string} panel @param {Shown} shown */
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
 * @param {Shown} shown
 * @param {string | undefined} chosen
 * @param {Ref} element
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

// @ts-check
/* What a mouse does on the rows of a tree, which hears it for all of them. As in RViz the first
 * click on a row selects it, and the next one edits its value. */

import { useRef } from "../vendor/preact.js";
import { rows } from "../wire/channel.js";
import { fold, select, selected } from "../state.js";
import { canOpen } from "./tree_keys.js";

/** @typedef {import("../wire/rows.js").Row} Row */
/**
 * What a row asks its tree to do.
 * @typedef {{panel: string, go: (id: string | undefined) => void,
 *   openMenu: (event: Press | Key, row: Row) => void, onDouble?: (row: Row) => boolean,
 *   rename?: (id: string, name: string | null) => void,
 *   drag: (event: Press, row: Row) => void}} TreeApi
 */

/** The row that an event is in. @param {Event & {readonly target: HTMLElement}} event */
const rowAt = (event) => rows.get(event.target.closest("[data-row]")?.dataset.row || "");

/** Fold a row, or unfold it: a search shows what is below folded rows too.
 * @param {Press} event @param {Row} row */
function toggle(event, row) {
  const shut = event.target.closest("[data-row]")?.getAttribute("aria-expanded") === "false";
  if (canOpen(row.id)) fold(row.id, shut);
}

/**
 * The handlers of a tree.
 * @param {{current: TreeApi}} api
 * @param {(id: string) => void} touch called before a row has the focus or a hand
 * @param {(id: string) => void} press called when a row is pressed
 */
export function useRowMouse(api, touch, press) {
  /** Whether the row was not selected when a mouse was pressed on it. */
  const pressed = useRef(false);
  return {
    /** @param {Press} event */
    onPointerDownCapture(event) {
      const row = rowAt(event);
      if (!row) return;
      const { panel } = api.current;
      const byMouse = event.button === 0 && event.pointerType !== "touch";
      pressed.current = byMouse && selected.value[panel] !== row.id && row.kind !== "slider";
      press(row.id);
      if (event.button !== 0 || event.target.closest("input, select, button, a, label, .twist"))
        return;
      select(panel, row.id);
      api.current.drag(event, row);
    },
    /** @param {Press} event */
    onMouseDown(event) {
      if (event.detail > 1 && event.target.closest(".name") && !event.target.matches("input"))
        event.preventDefault();
    },
    /** @param {Press} event */
    onClickCapture(event) {
      if (!pressed.current || !event.target.closest("input.field:not(.rename)")) return;
      event.stopPropagation();
      api.current.go(rowAt(event)?.id);
    },
    /** @param {Press} event */
    onClick(event) {
      const row = event.target.closest(".twist") && rowAt(event);
      if (row) toggle(event, row);
    },
    /** @param {Press} event */
    onDblClick(event) {
      const row = rowAt(event);
      const cell = event.target.closest(".name, .value");
      const { onDouble, rename } = api.current;
      if (!row || !cell || event.target.closest(".twist, input, select, button")) return;
      if (onDouble?.(row) || cell.matches(".value")) return;
      if (row.bold && rename) rename(row.id, null);
      else toggle(event, row);
    },
    /** @param {Press} event */
    onContextMenu(event) {
      const row = rowAt(event);
      const inField = event.target.matches("input.field, input[type=range]");
      if (row && !inField) api.current.openMenu(event, row);
    },
    /** @param {Press} event */
    onfocusin(event) {
      const row = rowAt(event);
      if (!row) return;
      touch(row.id);
      select(api.current.panel, row.id);
    },
  };
}

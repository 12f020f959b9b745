// @ts-check
/* A panel's rows as RViz's property tree: a tree grid with the keys of one. */

import { html, useEffect, useRef } from "./vendor/preact.js";
import { act, rows, send } from "./channel.js";
import { CopyButton, ValueCell } from "./cells.js";
import { Icon } from "./icons.js";
import { refusals } from "./notices.js";
import { fold, folds, isOpen, select, selected, useRow } from "./state.js";

/** @typedef {import("./rows.js").Row} Row */

const HIDDEN = new Set(["action", "names"]);

/** The ids of the rows that are unfolded, with their depth, in order.
 * @param {string} panel @param {(row: Row) => boolean} [wanted] a search: only rows it finds */
export function visible(panel, wanted) {
  /** @type {{id: string, depth: number}[]} */
  const found = [];
  /** @param {string} key @param {number} depth */
  const walk = (key, depth) => {
    for (const id of rows.children(key)) {
      const row = rows.get(id);
      if (!row || HIDDEN.has(row.kind) || row.apart) continue;
      const inside = rows.children(id).length > 0;
      if (!wanted || wanted(row)) found.push({ id, depth });
      if (inside && (wanted || isOpen(id))) walk(id, depth + 1);
    }
  };
  walk(`panel:${panel}`, 0);
  return found;
}

/** @param {string} id */
export function canOpen(id) { return rows.children(id).length > 0 || Boolean(rows.get(id)?.lazy); }

/** Unfold or fold a row; what is below some rows only comes when it is asked for.
 * @param {string} panel @param {string} id @param {boolean} open */
export function setOpen(panel, id, open) {
  if (open && rows.get(id)?.lazy && !rows.children(id).length) act(`${panel}/unfold`, [id]);
  fold(id, open);
}

/**
 * @param {{panel: string, label: string, wanted?: (row: Row) => boolean,
 *   onKey?: (event: KeyboardEvent, row: Row) => boolean | void,
 *   onMenu?: (event: any, row: Row) => void, renaming?: string, rename?: (id: string, name: string | null) => void,
 *   onDouble?: (row: Row) => boolean,
 *   drag?: (event: any, row: Row) => void}} props
 *   onKey: more keys on a selected row; it returns whether it used the key
 *   onDouble: what a double click does; it returns whether it did anything
 */
export function Tree({ panel, label, wanted, onKey, onMenu, onDouble, renaming, rename, drag }) {
  useRow(`panel:${panel}`);
  folds.use();
  const chosen = selected.use()[panel];
  const element = useRef(/** @type {any} */ (null));
  const shown = visible(panel, wanted);
  const current = shown.some(({ id }) => id === chosen) ? chosen : shown[0]?.id;

  /** @param {string | undefined} id */
  const go = (id) => {
    if (!id) return;
    select(panel, id);
    const row = element.current?.querySelector(`[data-row="${CSS.escape(id)}"]`);
    row?.focus();
    row?.scrollIntoView({ block: "nearest" });
  };
  /** @param {any} event */
  const key = (event) => {
    const onRow = event.target.dataset?.row === current;
    if (!current || event.ctrlKey || event.metaKey) return;
    const row = /** @type {Row} */ (rows.get(current));
    const at = shown.findIndex(({ id }) => id === current);
    const inField = event.target.matches?.("input:not([type=checkbox]), select, textarea");
    if (inField) {
      if (event.key === "Escape") { event.preventDefault(); event.stopPropagation(); go(current); }
      return;
    }
    const open = canOpen(current) && isOpen(current);
    if (event.key === "ArrowDown") go(shown[at + 1]?.id);
    else if (event.key === "ArrowUp") go(shown[at - 1]?.id);
    else if (event.key === "PageDown") go(shown[Math.min(shown.length - 1, at + 10)]?.id);
    else if (event.key === "PageUp") go(shown[Math.max(0, at - 10)]?.id);
    else if (event.key === "Home") go(shown[0]?.id);
    else if (event.key === "End") go(shown[shown.length - 1]?.id);
    else if (event.key === "ArrowRight") {
      if (canOpen(current) && !open) setOpen(panel, current, true);
      else go(rows.children(current)[0]);
    } else if (event.key === "ArrowLeft") {
      if (open) setOpen(panel, current, false); else go(row.in);
    } else if (onRow && event.key === " " && typeof row.value === "boolean" && !row.fixed) {
      send(row.id, !row.value);
    } else if (onRow && (event.key === "Enter" || event.key === "F2") && !onKey?.(event, row)) {
      event.target.querySelector("input, select")?.focus();
    } else if (onRow && /^[\d.+-]$/.test(event.key) && ["int", "float", "slider"].includes(row.kind)) {
      event.target.querySelector("input.num")?.focus();
      return;
    } else if (!onKey?.(event, row)) return;
    event.preventDefault();
    event.stopPropagation();
  };
  return html`<div class="tree" role="treegrid" aria-label=${label} data-panel=${panel} ref=${element} onKeyDown=${key}>
    ${shown.map(({ id, depth }) => html`<${RowView} key=${id} id=${id} depth=${depth} panel=${panel}
      current=${id === current} chosen=${id === chosen} onMenu=${onMenu} onDouble=${onDouble} drag=${drag}
      renaming=${renaming === id} rename=${rename} />`)}
  </div>`;
}

/** @param {any} props */
function RowView({ id, depth, panel, current, chosen, onMenu, onDouble, renaming, rename, drag }) {
  const row = /** @type {Row | undefined} */ (useRow(id));
  if (!row) return null;
  const opens = canOpen(id), open = opens && isOpen(id);
  const tab = current ? 0 : -1;
  const why = refusals.get(id);
  const wide = row.kind === "note" || row.kind === "lines";
  return html`<div class=${`row k-${row.kind} l-${row.level || "none"}${row.bold ? " bold" : ""}${row.off ? " off" : ""}`}
      role="row" aria-level=${depth + 1} aria-expanded=${opens ? String(open) : undefined}
      aria-selected=${chosen ? "true" : "false"} tabindex=${tab} data-row=${id}
      style=${`--depth: ${depth}`} title=${wide || row.kind === "slider" ? undefined : row.help}
      onfocusin=${() => select(panel, id)}
      onPointerDown=${(/** @type {any} */ e) => { if (e.button === 0 && !e.target.closest("input, select, button, .twist")) { select(panel, id); drag?.(e, row); } }}
      onContextMenu=${(/** @type {any} */ e) => { if (onMenu && !e.target.matches("input")) { e.preventDefault(); select(panel, id); onMenu(e, row); } }}>
    ${wide ? html`<span class="wide" role="gridcell">${row.kind === "lines" ? html`<pre>${row.value}</pre>` : row.value}</span>
      ${row.copy && html`<${CopyButton} row=${row} tab=${tab} />`}` : html`
    <span class="name" role="gridcell" onMouseDown=${(/** @type {any} */ e) => { if (e.detail > 1 && !e.target.matches("input")) e.preventDefault(); }} onDblClick=${() => (onDouble?.(row) ? undefined : row.bold && rename ? rename(id, null) : opens && setOpen(panel, id, !open))}>
      <span class=${`twist${opens ? (open ? " open" : "") : " none"}`} aria-hidden="true"
        onClick=${() => opens && setOpen(panel, id, !open)}></span>
      ${(row.icon || row.level) && html`<${Icon} name=${row.kind === "status" ? row.level : row.icon || row.level} />`}
      ${renaming ? html`<${NameField} row=${row} done=${rename} />`
        : html`<span class="label" title=${row.name}>${row.name}${label(row)}</span>`}
    </span>
    <span class="value" role="gridcell" onDblClick=${(/** @type {any} */ e) => e.target.closest("input, select, button") || onDouble?.(row)}><${ValueCell} row=${row} tab=${tab} /></span>`}
    ${why && html`<span class="why" role="alert">${why}</span>`}
  </div>`;
}

/** What stands behind a name: the level of a whole status. @param {Row} row */
function label(row) {
  return row.kind === "status" && ["Status", "Global Status"].includes(row.name || "") ? `: ${row.value}` : "";
}

/** @param {{row: Row, done: (id: string, name: string | null) => void}} props */
function NameField({ row, done }) {
  const element = useRef(/** @type {any} */ (null));
  const over = useRef(false);
  useEffect(() => { element.current.value = row.name || ""; element.current.focus(); element.current.select(); }, []);
  /** @param {string} text */
  const end = (text) => { if (!over.current) { over.current = true; done(row.id, text); } };
  return html`<input class="field rename" ref=${element} aria-label="Name" spellcheck=${false}
    onKeyDown=${(/** @type {any} */ e) => {
      e.stopPropagation();
      if (e.key === "Enter") end(e.target.value); else if (e.key === "Escape") end("");
    }} onBlur=${(/** @type {any} */ e) => end(e.target.value)} />`;
}

// @ts-check
/* One row of a tree: its name at the left, its value at the right. */

import { html, useLayoutEffect, useRef } from "../vendor/preact.js";
import { CopyButton, ValueCell } from "../cells/cells.js";
import { Icon } from "../window/icons.js";
import { refusals } from "../window/notices.js";
import { fold, select, useRow } from "../state.js";
import { Why } from "../cells/validation_message.js";

/** @typedef {import("../wire/rows.js").Row} Row */

/** A status that is longer is below its name, over the whole width. */
const BESIDE = 24;
const NUMBERS = new Set(["int", "float", "slider", "vector"]);
const TEXTS = new Set(["text", "file", "frame", "color"]);

/**
 * Whether a key on a selected row begins to replace its value.
 * @param {Row} row
 * @param {string} key
 */
export function edits(row, key) {
  if (row.fixed || row.off) return false;
  if (key === "Delete" || key === "Backspace") return NUMBERS.has(row.kind) || TEXTS.has(row.kind);
  if (key.length !== 1) return false;
  if (NUMBERS.has(row.kind)) return /[\d.,+\-(]/.test(key);
  return key !== " " && (TEXTS.has(row.kind) || Boolean(row.kind === "enum" && row.editable));
}

/**
 * @param {{id: string, depth: number, opens: boolean, open: boolean, current: boolean, chosen:
 *   boolean,
 *   renaming: boolean, api: {current: any}}} props
 *   opens: whether rows are below it; current: whether the Tab key stops here; api: of the tree
 */
export function RowView({ id, depth, opens, open, current, chosen, renaming, api }) {
  const row = /** @type {Row | undefined} */ (useRow(id));
  /** Whether the row was not selected when a mouse was pressed on it. */
  const pressed = useRef(false);
  if (!row) return null;
  const tab = current ? 0 : -1;
  const why = refusals.get(id);
  // A name without a value beside it has the whole width.
  const alone = row.kind === "group" || row.whole;
  const long = row.kind === "status" && String(row.value).length > BESIDE;
  const wide = row.kind === "note" || row.kind === "lines";
  /** @param {any} event */
  const press = (event) => {
    pressed.current =
      event.button === 0 && !chosen && event.pointerType !== "touch" && row.kind !== "slider";
    if (event.button !== 0 || event.target.closest("input, select, button, label, .twist")) return;
    select(api.current.panel, id);
    api.current.drag(event, row);
  };
  // As in RViz the first click selects a row, and the next one edits its value.
  /** @param {any} event */
  const click = (event) => {
    if (!pressed.current || !event.target.closest("input.field:not(.rename)")) return;
    event.stopPropagation();
    api.current.go(id);
  };
  /** @param {any} event */
  const menu = (event) => {
    if (!event.target.matches("input.field, input[type=range]")) api.current.openMenu(event, row);
  };
  /** @param {any} event */
  const twice = (event) => {
    if (event.target.closest(".twist, input, select, button") || api.current.onDouble?.(row))
      return;
    if (event.currentTarget.matches(".value")) return;
    if (row.bold && api.current.rename) api.current.rename(id, null);
    else if (opens) fold(id, !open);
  };
  const twist = html`<span class=${`twist${opens ? (open ? " open" : "") : " none"}`} aria-hidden="true"
    onClick=${() => opens && fold(id, !open)}></span>`;
  return html`<div class=${`row k-${row.kind} l-${row.level || "none"}${row.bold ? " bold" : ""}${row.off ? " off" : ""}${row.value === false ? " unticked" : ""}${alone ? " alone" : ""}${long ? " long" : ""}`}
      role="row" aria-level=${depth + 1} aria-expanded=${opens ? String(open) : undefined}
      aria-selected=${chosen ? "true" : "false"} tabindex=${tab} data-row=${id}
      style=${`--depth: ${depth}`} title=${api.current.hover && !wide && row.kind !== "slider" ? row.help : undefined}
      onfocusin=${() => select(api.current.panel, id)} onPointerDownCapture=${press} onClickCapture=${click}
      onContextMenu=${menu}>
    ${
      wide
        ? html`<${Wide} row=${row} twist=${twist} />${row.copy && html`<span role="gridcell"><${CopyButton} row=${row} tab=${tab} /></span>`}`
        : html`
    <span class="name" role="gridcell"
      onMouseDown=${(/** @type {any} */ e) => {
        if (e.detail > 1 && !e.target.matches("input")) e.preventDefault();
      }} onDblClick=${twice}>
      ${twist}
      ${(row.icon || row.level) && html`<${Icon} name=${row.kind === "status" ? row.level : row.icon || row.level} />`}
      ${
        renaming
          ? html`<${NameField} row=${row} done=${api.current.rename} />`
          : html`<span class="label" title=${row.name}>${row.name}${row.whole ? `: ${row.value}` : ""}</span>`
      }
    </span>
    ${!alone && html`<span class="value" role="gridcell" onDblClick=${twice}><${ValueCell} row=${row} tab=${tab} /></span>`}`
    }
    ${why && html`<${Why} text=${why} />`}
  </div>`;
}

/** A sentence or lines of a file over the whole width. @param {{row: Row, twist: any}} props */
function Wide({ row, twist }) {
  const text =
    row.kind === "lines"
      ? html`<${Lines} row=${row} />`
      : html`<span class="said">${row.value}</span>`;
  return html`<span class="wide" role="gridcell">
    ${twist}${row.level && row.kind === "note" && html`<${Icon} name=${row.level} />`}${text}
    ${row.place && html`<span class="at">${row.place}</span>`}
  </span>`;
}

/**
 * Lines of text; of a file with their numbers, and the word that matters.
 * @param {{row: Row}} props
 */
function Lines({ row }) {
  if (!Array.isArray(row.value)) return html`<pre>${row.value}</pre>`;
  return html`<pre>${row.value.map(
    ([number, line]) => html`<div class=${number === row.line ? "marked" : ""}
    ><span class="line-number" aria-hidden="true">${number}</span>${number === row.line && row.column ? marked(line, row.column - 1) : line || " "}</div>`,
  )}</pre>`;
}

/** @param {string} line @param {number} at */
function marked(line, at) {
  const word = line.slice(at).match(/^(?:<\/?[\w:.-]+|[\w:.-]+|\S)/)?.[0] || "";
  return html`${line.slice(0, at)}<mark>${word || " "}</mark>${line.slice(at + word.length)}`;
}

/** @param {{row: Row, done: (id: string, name: string | null) => void}} props */
function NameField({ row, done }) {
  const element = useRef(/** @type {any} */ (null));
  const over = useRef(false);
  // Before the first key that is typed.
  useLayoutEffect(() => {
    element.current.value = row.name || "";
    element.current.focus();
    element.current.select();
  }, []);
  /** @param {string} text */
  const end = (text) => {
    if (!over.current) {
      over.current = true;
      done(row.id, text);
    }
  };
  return html`<input class="field rename" ref=${element} aria-label="Name" spellcheck=${false}
    onKeyDown=${(/** @type {any} */ e) => {
      e.stopPropagation();
      if (e.key !== "Enter" && e.key !== "Escape") return;
      end(e.key === "Enter" ? e.target.value : "");
      e.target.closest("[data-row]").focus();
    }} onBlur=${(/** @type {any} */ e) => end(e.target.value)} />`;
}

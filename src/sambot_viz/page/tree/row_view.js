// @ts-check
/* One row of a tree: its name at the left, its value at the right. */

import { html, useLayoutEffect, useRef } from "../vendor/preact.js";
import { CopyButton, ValueCell } from "../cells/cells.js";
import { Icon } from "../window/icons.js";
import { refusals } from "../window/notices.js";
import { rows } from "../wire/channel.js";
import { fold, select, useRow } from "../state.js";
import { ValidationMessage } from "../cells/validation_message.js";

/** @typedef {import("../wire/rows.js").Row} Row */
/**
 * What a row asks its tree to do.
 * @typedef {{panel: string, hover: boolean, go: (id: string | undefined) => void,
 *   openMenu: (event: Press | Key, row: Row) => void, onDouble?: (row: Row) => boolean,
 *   rename?: (id: string, name: string | null) => void,
 *   drag: (event: Press, row: Row) => void}} TreeApi
 */

/** Why a viewer's controls are grey. */
const VIEW_ONLY = "View only: request control to change it";
/** A status, or another sentence, that is longer is below its name, over the whole width. */
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
  // A number may begin with a letter, as in "pi/2": a key of a tool would not be meant.
  const typed = NUMBERS.has(row.kind) || TEXTS.has(row.kind);
  return key !== " " && (typed || Boolean(row.kind === "enum" && row.editable));
}

/**
 * @param {{id: string, depth: number, opens: boolean, open: boolean, current: boolean,
 *   chosen: boolean, renaming: boolean, api: {current: TreeApi}}} props
 *   opens: whether rows are below it; current: whether the Tab key stops here
 */
export function RowView({ id, depth, opens, open, current, chosen, renaming, api }) {
  const row = /** @type {Row | undefined} */ (useRow(id));
  const mouse = useRowMouse(api, row, chosen);
  if (!row) return null;
  const tab = current ? 0 : -1;
  const refused = refusals.get(id);
  const wide = row.kind === "note" || row.kind === "lines";
  const twist = html`<span class=${`twist ${opens ? (open ? "open" : "") : "none"}`}
    aria-hidden="true" onClick=${() => opens && fold(id, !open)}></span>`;
  /** @param {Press} event */
  const twice = (event) => {
    const { onDouble, rename } = api.current;
    if (event.target.closest(".twist, input, select, button") || onDouble?.(row)) return;
    if (event.currentTarget.matches(".value")) return;
    if (row.bold && rename) rename(id, null);
    else if (opens) fold(id, !open);
  };
  const cells = wide
    ? html`<${Wide} row=${row} twist=${twist} tab=${tab} />`
    : html`<${Name} row=${row} twist=${twist} twice=${twice}
      rename=${renaming && api.current.rename} />
      ${
        !alone(row) &&
        html`<span class="value" role="gridcell" onDblClick=${twice}>
        <${ValueCell} row=${row} tab=${tab} /></span>`
      }`;
  const locked = row.off && rows.watching ? VIEW_ONLY : undefined;
  const help = api.current.hover && !wide && row.kind !== "slider" ? row.help : undefined;
  return html`<div class=${rowClass(row)} role="row" data-row=${id} tabindex=${tab} title=${locked || help}
      aria-level=${depth + 1} aria-expanded=${opens ? String(open) : undefined}
      aria-selected=${chosen ? "true" : "false"} style=${`--depth: ${depth}`} ...${mouse}
      onfocusin=${() => select(api.current.panel, id)}>
    ${cells}
    ${refused && html`<${ValidationMessage} text=${refused} />`}
  </div>`;
}

/** A name without a value beside it has the whole width. @param {Row} row */
const alone = (row) => row.kind === "group" || row.whole;

/** @param {Row} row */
function rowClass(row) {
  const classes = ["row", `k-${row.kind}`, `l-${row.level || "none"}`];
  const wraps = row.kind === "status" || row.wraps;
  const long = wraps && String(row.value).length > BESIDE;
  const states = { bold: row.bold, off: row.off, unticked: row.value === false, alone: alone(row) };
  for (const [name, on] of Object.entries({ ...states, long })) if (on) classes.push(name);
  return classes.join(" ");
}

/**
 * What a mouse does on a row. As in RViz the first click selects it, and the next one edits
 * its value.
 * @param {{current: TreeApi}} api
 * @param {Row | undefined} row
 * @param {boolean} chosen
 */
function useRowMouse(api, row, chosen) {
  /** Whether the row was not selected when a mouse was pressed on it. */
  const pressed = useRef(false);
  return {
    /** @param {Press} event */
    onPointerDownCapture(event) {
      if (!row) return;
      const byMouse = event.button === 0 && event.pointerType !== "touch";
      pressed.current = byMouse && !chosen && row.kind !== "slider";
      if (event.button !== 0 || event.target.closest("input, select, button, label, .twist"))
        return;
      select(api.current.panel, row.id);
      api.current.drag(event, row);
    },
    /** @param {Press} event */
    onClickCapture(event) {
      if (!pressed.current || !event.target.closest("input.field:not(.rename)")) return;
      event.stopPropagation();
      api.current.go(row?.id);
    },
    /** @param {Press} event */
    onContextMenu(event) {
      const inField = event.target.matches("input.field, input[type=range]");
      if (row && !inField) api.current.openMenu(event, row);
    },
  };
}

/**
 * @param {{row: Row, twist: any, twice: (event: Press) => void,
 *   rename?: TreeApi["rename"] | false}} props rename: while it is renamed
 */
function Name({ row, twist, twice, rename }) {
  /** @param {Press} event */
  const press = (event) => {
    if (event.detail > 1 && !event.target.matches("input")) event.preventDefault();
  };
  const isBad = row.level === "error" || row.level === "warn";
  const isLevel = row.kind === "status" || (row.kind === "display" && isBad);
  const icon = isLevel ? row.level : row.icon || row.level;
  const text = `${row.name}${row.whole ? `: ${row.value}` : ""}`;
  return html`<span class="name" role="gridcell" onMouseDown=${press} onDblClick=${twice}>
    ${twist}
    ${icon && html`<${Icon} name=${icon} />`}
    ${
      rename
        ? html`<${NameField} row=${row} done=${rename} />`
        : html`<span class="label" title=${row.name}>${text}</span>`
    }
  </span>`;
}

/**
 * A sentence or lines of a file over the whole width.
 * @param {{row: Row, twist: any, tab: number}} props
 */
function Wide({ row, twist, tab }) {
  const text =
    row.kind === "lines"
      ? html`<${Lines} row=${row} />`
      : html`<span class="said">${row.value}</span>`;
  return html`<span class="wide" role="gridcell">
    ${twist}${row.level && row.kind === "note" && html`<${Icon} name=${row.level} />`}${text}
    ${row.place && html`<span class="at">${row.place}</span>`}
  </span>${row.copy && html`<span role="gridcell"><${CopyButton} row=${row} tab=${tab} /></span>`}`;
}

/**
 * Lines of text; of a file with their numbers, and the word that matters.
 * @param {{row: Row}} props
 */
function Lines({ row }) {
  if (!Array.isArray(row.value)) return html`<pre class="table">${row.value}</pre>`;
  return html`<pre>${row.value.map(([number, line]) => {
    const here = number === row.line;
    const text = here && row.column ? marked(line, row.column - 1) : line || " ";
    return html`<div class=${here ? "marked" : ""}
      ><span class="line-number" aria-hidden="true">${number}</span>${text}</div>`;
  })}</pre>`;
}

/** @param {string} line @param {number} at */
function marked(line, at) {
  const word = line.slice(at).match(/^(?:<\/?[\w:.-]+|[\w:.-]+|\S)/)?.[0] || "";
  return html`${line.slice(0, at)}<mark>${word || " "}</mark>${line.slice(at + word.length)}`;
}

/** @param {{row: Row, done: (id: string, name: string | null) => void}} props */
function NameField({ row, done }) {
  /** @type {Ref<HTMLInputElement>} */
  const element = useRef(null);
  const over = useRef(false);
  // Before the first key that is typed.
  useLayoutEffect(() => {
    element.current.value = row.name || "";
    element.current.focus();
    element.current.select();
  }, []);
  /** @param {string} text */
  const end = (text) => {
    if (!over.current) done(row.id, text);
    over.current = true;
  };
  /** @param {Key} event */
  const key = (event) => {
    event.stopPropagation();
    if (event.key !== "Enter" && event.key !== "Escape") return;
    end(event.key === "Enter" ? element.current.value : "");
    /** @type {HTMLElement | null} */ (element.current.closest("[data-row]"))?.focus();
  };
  return html`<input class="field rename" ref=${element} aria-label="Name" spellcheck=${false}
    onKeyDown=${key} onBlur=${() => end(element.current.value)} />`;
}

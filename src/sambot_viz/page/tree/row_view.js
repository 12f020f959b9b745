// @ts-check
/* One row of a tree: its name at the left, its value at the right. */

import { html, useLayoutEffect, useRef } from "../vendor/preact.js";
import { ActButton, CopyButton, ValueCell } from "../cells/cells.js";
import { Icon } from "../window/icons.js";
import { refusals } from "../window/notices.js";
import { useRow } from "../state.js";
import { ValidationMessage } from "../cells/validation_message.js";
import { alone, isWide } from "./row_element.js";
import { nameText } from "./row_text.js";

/** @typedef {import("../wire/rows.js").Row} Row */
/** @typedef {import("./row_mouse.js").TreeApi} TreeApi */

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
 * What is in the element of a row.
 * @param {{id: string, opens: boolean, open: boolean, current: boolean, renaming: boolean,
 *   api: {current: TreeApi}}} props
 *   opens: whether rows are below it; current: whether the Tab key stops here
 */
export function RowView({ id, opens, open, current, renaming, api }) {
  const row = /** @type {Row | undefined} */ (useRow(id));
  if (!row) return null;
  const tab = current ? 0 : -1;
  const refused = refusals.get(id);
  const twist = html`<span class=${`twist ${opens ? (open ? "open" : "") : "none"}`}
    aria-hidden="true"></span>`;
  const cells = isWide(row)
    ? html`<${Wide} row=${row} twist=${twist} tab=${tab} />`
    : html`<${Name} row=${row} twist=${opens && twist} rename=${renaming && api.current.rename} />
      ${
        !alone(row) &&
        html`<span class="value" role="gridcell"><${ValueCell} row=${row} tab=${tab} /></span>`
      }`;
  return html`${cells}${refused && html`<${ValidationMessage} text=${refused} />`}`;
}

/**
 * @param {{row: Row, twist: any, rename?: TreeApi["rename"] | false}} props
 *   rename: while it is renamed
 */
function Name({ row, twist, rename }) {
  const isBad = row.level === "error" || row.level === "warn";
  const isLevel = row.kind === "status" || (row.kind === "display" && isBad);
  const icon = isLevel ? row.level : row.icon || row.level;
  return html`<span class="name" role="gridcell">
    ${twist}
    ${icon && html`<${Icon} name=${icon} />`}
    ${
      rename
        ? html`<${NameField} row=${row} done=${rename} />`
        : html`<span class="label" title=${row.name}>${nameText(row)}</span>`
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
  </span>${row.about && html`<span role="gridcell"><${AboutLink} row=${row} tab=${tab} /></span>`}
  ${row.copy && html`<span role="gridcell"><${CopyButton} row=${row} tab=${tab} /></span>`}
  ${row.act && html`<span role="gridcell"><${ActButton} row=${row} tab=${tab} /></span>`}`;
}

/** Leads to what the code of a problem means. @param {{row: Row, tab: number}} props */
function AboutLink({ row, tab }) {
  const title = `What ${row.about} means, with an example`;
  return html`<a class="about" href=${`help/${encodeURIComponent(row.about)}`} target="_blank"
    rel="noopener" tabindex=${tab} title=${title} aria-label=${title}><${Icon} name="help" /></a>`;
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

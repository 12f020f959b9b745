// @ts-check
/* The value of a row, and how a hand changes it: one component for each kind. */

import { html, useRef } from "../vendor/preact.js";
import { act, newGesture, rows, send } from "../wire/channel.js";
import { copy } from "../window/clipboard.js";
import { Combo } from "./combo.js";
import { Field, leave } from "./field.js";
import { Icon } from "../window/icons.js";
import { refusals, refuse } from "../window/notices.js";
import { NumberCell, SliderCell } from "./number_cells.js";
import { formatNumber, parseNumber } from "./numbers.js";
import { degrees, useData, wantedRow } from "../state.js";
import { shownUnit, unitBeside } from "./units.js";

/** @typedef {import("../wire/rows.js").Row} Row */

/**
 * The value cell of a row.
 * @param {{row: Row, tab: number}} props tab: whether the Tab key stops here (0 or -1)
 */
export function ValueCell({ row, tab }) {
  const Cell = CELLS[row.kind];
  return Cell ? html`<${Cell} row=${row} tab=${tab} />` : null;
}

/** @param {{row: Row, tab: number}} props */
export function Box({ row, tab }) {
  // The label is what a finger hits.
  return html`<label class="tick"><input type="checkbox" class="box" aria-label=${row.name || ""}
    tabindex=${tab}
    checked=${Boolean(row.value)} disabled=${row.fixed || row.off}
    onChange=${(/** @type {Change} */ e) => send(row.id, e.target.checked)} /></label>`;
}

/** The value of a row, with the folders that only a presenter sees; in a component. @param {Row} row */
const useWhole = (row) => useData("displays/paths")?.[row.id] ?? row.value;

/** @param {{row: Row, tab: number}} props */
function TextCell({ row, tab }) {
  return html`<${Field} row=${row} tab=${tab} shown=${String(useWhole(row) ?? "")}
    accept=${(/** @type {string} */ typed) => {
      send(row.id, typed);
    }} />`;
}

/** Several numbers in one field, as RViz writes a vector. @param {{row: Row, tab: number}} props */
function VectorCell({ row, tab }) {
  degrees.use();
  const { unit, factor } = shownUnit(row);
  const beside = unitBeside(row, unit);
  const texts = row.value.map((/** @type {number} */ part) => formatNumber(part * factor, 5));
  /** @param {string} typed */
  const accept = (typed) => {
    const values = typed
      .split(/[;\s]+/)
      .filter(Boolean)
      .map((part, i) => {
        // What was not changed keeps the digits that are not shown.
        if (part === texts[i]) return row.value[i];
        const read = parseNumber(part, unit);
        return "value" in read ? read.value : NaN;
      });
    if (values.length !== row.value.length || values.some(Number.isNaN)) {
      return `Enter ${row.value.length} numbers, e.g. ${row.value.map(() => "0").join("; ")}`;
    }
    send(row.id, values);
  };
  return html`<span class="number" data-unit=${beside || undefined}>
    <${Field} row=${row} tab=${tab} shown=${texts.join("; ")} accept=${accept} /></span>`;
}

/** @param {{row: Row, tab: number}} props */
function ColorCell({ row, tab }) {
  const hex =
    "#" +
    row.value.map((/** @type {number} */ part) => part.toString(16).padStart(2, "0")).join("");
  // All that is picked until the picker is closed is one step for undo.
  const gesture = useRef(0);
  return html`<span class="color">
    <input type="color" value=${hex} tabindex=${tab} disabled=${row.fixed || row.off}
      aria-label=${`${row.name}, choose`}
      onInput=${(/** @type {Change} */ e) => send(row.id, e.target.value, (gesture.current ||= newGesture()))}
      onChange=${() => {
        gesture.current = 0;
      }} />
    <${Field} row=${row} tab=${tab} shown=${row.value.join("; ")}
      accept=${(/** @type {string} */ typed) => {
        send(row.id, typed);
      }} />
  </span>`;
}

/** RViz's own types of views go without the name of their package, which would be cut off.
 * @param {any} value */
const short = (value) =>
  typeof value === "string" ? value.replace(/ \(rviz_default_plugins\)$/, "") : value;

/** @param {{row: Row, tab: number}} props */
function EnumCell({ row, tab }) {
  const options = row.options || [];
  if (row.editable) return html`<${ComboCell} row=${row} tab=${tab} options=${options} />`;
  const offered = options.includes(row.value) ? options : [row.value, ...options];
  return html`<select class="field" aria-label=${row.name || ""} tabindex=${tab}
      disabled=${row.fixed || row.off} value=${row.value}
      onChange=${(/** @type {Change} */ e) => send(row.id, e.target.value)}>
    ${offered.map((option) => html`<option value=${option}>${short(option)}</option>`)}
  </select>`;
}

/** @param {{row: Row, tab: number}} props */
function FrameCell({ row, tab }) {
  useData("names/frames");
  const options = [...(row.options || []), ...(rows.data("names/frames") || [])];
  return html`<${ComboCell} row=${row} tab=${tab} options=${options} />`;
}

/** @param {{row: Row, tab: number, options: string[]}} props */
function ComboCell({ row, tab, options }) {
  return html`<${Combo} label=${row.name || ""} value=${String(row.value ?? "")} options=${options}
    tab=${tab} title=${refusals.get(row.id)} invalid=${refusals.has(row.id)}
      off=${row.fixed || row.off} emptiable=${row.emptiable}
    accept=${(/** @type {string} */ chosen) => {
      refuse(row.id);
      send(row.id, chosen);
    }} leave=${leave} />`;
}

/** @param {{row: Row, tab: number}} props */
function FactCell({ row, tab }) {
  const value = useWhole(row);
  return html`<span class="fact" title=${row.kind === "readonly" ? String(value) : undefined}>
    ${short(value)}</span>
    ${row.repair && html`<${RepairButton} row=${row} tab=${tab} />`}
    ${row.leads && html`<${LeadButton} row=${row} tab=${tab} />`}
    ${row.copy && html`<${CopyButton} row=${row} tab=${tab} />`}`;
}

/** Sets another row so that what a status says is over. @param {{row: Row, tab: number}} props */
function RepairButton({ row, tab }) {
  const [label, id, value] = row.repair;
  return html`<button class=${`repair ${rows.get(id)?.local ? "" : "needs-control"}`}
    tabindex=${tab} onClick=${() => send(id, value)}>${label}</button>`;
}

/** Goes to a row that says more than a status. @param {{row: Row, tab: number}} props */
function LeadButton({ row, tab }) {
  const [label, panel, id] = row.leads;
  return html`<button class="repair" tabindex=${tab}
    onClick=${() => wantedRow.set({ panel, id })}>${label}</button>`;
}

/** Calls a command with which what a sentence says is done.
 * @param {{row: Row, tab: number}} props */
export function ActButton({ row, tab }) {
  const [label, command, id] = row.act;
  /** @param {Press} event */
  const press = (event) => {
    // What is at this place by the second click of a double one is another button.
    if (event.detail < 2) act(command, [id]);
  };
  return html`<button class="repair needs-control" tabindex=${tab} title=${row.value}
    onClick=${press}>${label}</button>`;
}

/** @param {{row: Row, tab: number}} props */
export function CopyButton({ row, tab }) {
  return html`<button class="flat copy" tabindex=${tab} aria-label=${`Copy ${row.name}`}
    title=${`Copy ${row.name}`}
    onClick=${() => copy(String(row.copy === true ? row.value : row.copy), `Copied: ${row.name || "the text"}`)}><${Icon} name="copy" />
      </button>`;
}

/** @type {Record<string, any>} */
const CELLS = {
  bool: Box,
  int: NumberCell,
  float: NumberCell,
  slider: SliderCell,
  text: TextCell,
  file: TextCell,
  vector: VectorCell,
  color: ColorCell,
  enum: EnumCell,
  frame: FrameCell,
  readonly: FactCell,
  display: (/** @type {any} */ { row, tab }) =>
    row.fixed ? null : html`<${Box} row=${row} tab=${tab} />`,
  status: (/** @type {any} */ { row, tab }) =>
    row.whole ? null : html`<${FactCell} row=${row} tab=${tab} />`,
};

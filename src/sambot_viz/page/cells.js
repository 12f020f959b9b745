// @ts-check
/* The value of a row, and how a hand changes it: one component for each kind. */

import { html, useEffect, useLayoutEffect, useRef, useState } from "./vendor/preact.js";
import { newGesture, rows, send } from "./channel.js";
import { Combo } from "./combo.js";
import { clamped, formatNumber, parseNumber, snapped, stepped } from "./numbers.js";
import { degrees, useRow } from "./state.js";

/** @typedef {import("./rows.js").Row} Row */

const DEGREE = Math.PI / 180;

/** What is shown of a row in radians while angles are in degrees.
 * @param {Row} row @returns {{unit: string, factor: number, step: number}} */
export function shownUnit(row, inDegrees = degrees.value) {
  const turn = inDegrees && (row.unit === "rad" || row.unit === "rad/s");
  const step = row.step || 0.01;
  if (!turn) return { unit: row.unit || "", factor: 1, step };
  return { unit: row.unit === "rad" ? "°" : "°/s", factor: 1 / DEGREE, step: DEGREE };
}

/** A refused value, by the id of its row, until the next edit. @type {Map<string, string>} */
export const refusals = new Map();

/** @param {string} id @param {string} [why] */
export function refuse(id, why) {
  if (why) refusals.set(id, why); else refusals.delete(id);
  rows.notify(id);
}

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
  return html`<input type="checkbox" class="box" aria-label=${row.name || ""} tabindex=${tab}
    checked=${Boolean(row.value)} disabled=${row.fixed || row.off}
    onChange=${(/** @type {any} */ e) => send(row.id, e.target.checked)} />`;
}

/** The first click marks the whole text, as typing is meant to replace it. @param {any} event */
export function focusWhole(event) {
  if (event.button === 0 && document.activeElement !== event.target) {
    event.preventDefault();
    event.target.focus();
  }
}

/**
 * A line of text that is accepted by Enter or by leaving it, and put back by Esc.
 * @param {{row: Row, shown: string, accept: (typed: string) => string | void, tab: number,
 *   step?: (count: number) => void, mode?: string, kind?: string}} props
 *   accept: returns why a text is refused
 */
export function Field({ row, shown, accept, tab, step, mode, kind = "" }) {
  // What is being typed is in the element: keys come faster than the page is drawn.
  const typing = useRef(false);
  const element = useRef(/** @type {any} */ (null));
  const why = refusals.get(row.id);
  const putBack = () => { typing.current = false; element.current.value = shown; };
  const done = () => {
    if (!typing.current) return;
    const typed = element.current.value;
    typing.current = false;
    const refused = typed === shown ? undefined : accept(typed) || undefined;
    if (refused) putBack();
    refuse(row.id, refused);
  };
  useLayoutEffect(() => { if (!typing.current) element.current.value = shown; });
  /** @param {any} event */
  const key = (event) => {
    if (event.key === "Enter") { event.preventDefault(); done(); element.current.select(); }
    else if (event.key === "Escape" && (typing.current || why)) {
      event.stopPropagation();
      putBack();
      refuse(row.id);
    } else if (step && (event.key === "ArrowUp" || event.key === "ArrowDown")) {
      event.preventDefault();
      putBack();
      refuse(row.id);
      step((event.key === "ArrowUp" ? 1 : -1) * (event.shiftKey ? 10 : event.altKey ? 0.1 : 1));
    }
  };
  return html`<input class=${`field ${kind}`} ref=${element} tabindex=${tab}
    aria-label=${row.name || ""} aria-invalid=${why ? "true" : undefined} title=${why || row.help || ""}
    inputmode=${mode} spellcheck=${false} autocomplete="off" readonly=${row.fixed} disabled=${row.off}
    onFocus=${(/** @type {any} */ e) => e.target.select()} onMouseDown=${focusWhole}
    onInput=${() => { typing.current = true; if (why) refuse(row.id); }}
    onKeyDown=${key} onBlur=${done} />`;
}

/** Refuse a number outside the limits of its row. @param {Row} row @param {number} value */
function outside(row, value) {
  const { unit, factor } = shownUnit(row);
  const low = row.min ?? -Infinity, high = row.max ?? Infinity;
  // A limit typed as it is shown, without all its digits, means the limit.
  if (value >= low - 1e-6 && value <= high + 1e-6) return "";
  const ends = [low, high].map((end) => (Number.isFinite(end) ? formatNumber(end * factor, 4) : end < 0 ? "−∞" : "∞"));
  return `outside ${ends[0]} … ${ends[1]} ${unit}`.trim();
}

/** @param {{row: Row, tab: number}} props */
export function NumberCell({ row, tab }) {
  degrees.use();
  const { unit, factor, step } = shownUnit(row);
  const gesture = useRef(0);
  /** @param {string} typed */
  const accept = (typed) => {
    const read = parseNumber(typed, unit);
    if ("error" in read) return read.error;
    const value = row.kind === "int" ? Math.round(read.value) : read.value;
    const why = outside(row, value);
    if (!why) send(row.id, clamped(value, row));
    return why;
  };
  /** @param {number} count */
  const move = (count) => {
    gesture.current ||= newGesture();
    const fine = Math.abs(count) < 1 && row.kind !== "int";
    const next = clamped(stepped(row.value, fine ? step / 10 : step, fine ? Math.sign(count) : Math.sign(count) * Math.max(1, Math.abs(count))), row);
    rows.patch(row.id, { value: next }, new Set());
    rows.notify(row.id);
    send(row.id, next, gesture.current);
  };
  return html`<span class="number"
      onfocusout=${() => { gesture.current = 0; }}>
    <${Field} row=${row} tab=${tab} kind="num" mode="decimal" accept=${accept}
      step=${row.fixed ? undefined : move} shown=${formatNumber(Number(row.value) * factor, 6)} />
    ${unit && html`<span class="unit">${unit}</span>`}
  </span>`;
}

/** A slider with its number: the row of a joint. @param {{row: Row, tab: number}} props */
export function SliderCell({ row, tab }) {
  degrees.use();
  const { factor, step, unit } = shownUnit(row);
  const low = row.min ?? 0, high = row.max ?? 1;
  /** The value under the hand, until the hand lets go. */
  const held = useRef(/** @type {{value: number, gesture: number} | null} */ (null));
  const [, again] = useState(0);
  const value = held.current ? held.current.value : Number(row.value);
  /** @param {number} raw @param {boolean} [exact] */
  const move = (raw, exact) => {
    // The ends are exact, whatever the step.
    const next = raw <= low ? low : raw >= high ? high : exact ? raw : clamped(snapped(raw, step), row);
    held.current ||= { value: next, gesture: newGesture() };
    held.current.value = next;
    send(row.id, next, held.current.gesture);
    again((n) => n + 1);
  };
  const release = () => {
    if (!held.current) return;
    // Until the server's answer is here, the row shows what the hand has set.
    rows.patch(row.id, { value: held.current.value }, new Set());
    held.current = null;
    again((n) => n + 1);
  };
  /** @param {any} event */
  const key = (event) => {
    const count = /** @type {Record<string, number>} */ ({
      ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: 10, PageDown: -10 })[event.key];
    if (event.ctrlKey || event.metaKey) return;
    if (count) move(stepped(value, step, count * (event.shiftKey ? 10 : 1)), true);
    else if (event.key === "Home") move(low);
    else if (event.key === "End") move(high);
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  const part = high > low ? (value - low) / (high - low) : 0;
  return html`<span class="slide">
    <input type="range" min=${low} max=${high} step="any" value=${value} tabindex=${tab}
      aria-label=${row.name || ""} disabled=${row.fixed || row.off} style=${`--part: ${part}`}
      aria-valuetext=${`${formatNumber(value * factor, 3)} ${unit}`}
      onInput=${(/** @type {any} */ e) => move(Number(e.target.value))}
      onChange=${release} onPointerUp=${release} onPointerCancel=${release}
      onKeyDown=${key} onKeyUp=${release} onBlur=${release} />
    <${NumberCell} row=${held.current ? { ...row, value } : row} tab=${tab} />
  </span>`;
}

/** @param {{row: Row, tab: number}} props */
function TextCell({ row, tab }) {
  return html`<${Field} row=${row} tab=${tab} shown=${String(row.value ?? "")}
    accept=${(/** @type {string} */ typed) => { send(row.id, typed); }} />`;
}

/** @param {{row: Row, tab: number}} props */
function VectorCell({ row, tab }) {
  /** @param {string} typed */
  const accept = (typed) => {
    const parts = typed.split(/[;\s]+/).filter(Boolean).map((part) => parseNumber(part, row.unit));
    const values = parts.map((part) => ("value" in part ? part.value : NaN));
    if (values.length !== row.value.length || values.some(Number.isNaN)) {
      return `type ${row.value.length} numbers, such as ${row.value.map(() => "0").join("; ")}`;
    }
    send(row.id, values);
  };
  const shown = row.value.map((/** @type {number} */ part) => formatNumber(part, 5)).join("; ");
  return html`<${Field} row=${row} tab=${tab} shown=${shown} accept=${accept} />`;
}

/** @param {{row: Row, tab: number}} props */
function ColorCell({ row, tab }) {
  const hex = "#" + row.value.map((/** @type {number} */ part) => part.toString(16).padStart(2, "0")).join("");
  const gesture = useRef(0);
  return html`<span class="color">
    <input type="color" value=${hex} tabindex=${tab} disabled=${row.fixed || row.off}
      aria-label=${`${row.name}, choose`}
      onFocus=${() => { gesture.current = newGesture(); }}
      onInput=${(/** @type {any} */ e) => send(row.id, e.target.value, gesture.current || newGesture())} />
    <${Field} row=${row} tab=${tab} shown=${row.value.join("; ")}
      accept=${(/** @type {string} */ typed) => { send(row.id, typed); }} />
  </span>`;
}

/** @param {{row: Row, tab: number}} props */
function EnumCell({ row, tab }) {
  const options = row.options || [];
  if (row.editable) return html`<${ComboCell} row=${row} tab=${tab} options=${options} />`;
  return html`<select class="field" aria-label=${row.name || ""} tabindex=${tab} title=${row.help || ""}
      disabled=${row.fixed || row.off}
      onChange=${(/** @type {any} */ e) => send(row.id, e.target.value)}>
    ${!options.includes(row.value) && html`<option selected>${row.value}</option>`}
    ${options.map((option) => html`<option selected=${option === row.value}>${option}</option>`)}
  </select>`;
}

/** @param {{row: Row, tab: number}} props */
function FrameCell({ row, tab }) {
  useRow("names/frames");
  const options = [...(row.options || []), ...(rows.value("names/frames") || [])];
  return html`<${ComboCell} row=${row} tab=${tab} options=${options} />`;
}

/** @param {{row: Row, tab: number, options: string[]}} props */
function ComboCell({ row, tab, options }) {
  return html`<${Combo} label=${row.name || ""} value=${String(row.value ?? "")} options=${options}
    tab=${tab} title=${refusals.get(row.id) || row.help || ""} invalid=${refusals.has(row.id)} off=${row.fixed || row.off}
    accept=${(/** @type {string} */ chosen) => { refuse(row.id); send(row.id, chosen); }} />`;
}

/** @param {{row: Row}} props */
function FactCell({ row }) {
  return html`<span class="fact" title=${String(row.value)}>${row.value}</span>`;
}

/** @type {Record<string, any>} */
const CELLS = {
  bool: Box, int: NumberCell, float: NumberCell, slider: SliderCell, text: TextCell,
  file: TextCell, vector: VectorCell, color: ColorCell, enum: EnumCell, frame: FrameCell,
  fact: FactCell, display: (/** @type {any} */ { row, tab }) => row.fixed ? null : html`<${Box} row=${row} tab=${tab} />`,
  status: (/** @type {any} */ { row }) => (row.name !== "Status" && row.name !== "Global Status" ? html`<${FactCell} row=${row} />` : null),
};

/** Show why an edit was refused, where it was made. */
export function useNotices() {
  const notice = useRow("notice")?.value;
  useEffect(() => { if (notice?.row) refuse(notice.row, notice.text); }, [notice?.number]);
  return notice;
}

// @ts-check
/* The value of a row, and how a hand changes it: one component for each kind. */

import { html, useLayoutEffect, useRef, useState } from "./vendor/preact.js";
import { act, newGesture, rows, send } from "./channel.js";
import { copy } from "./clipboard.js";
import { Combo } from "./combo.js";
import { Icon } from "./icons.js";
import { refusals, refuse } from "./notices.js";
import { clamped, formatNumber, parseNumber, snapped, stepped } from "./numbers.js";
import { degrees, useRow } from "./state.js";

/** @typedef {import("./rows.js").Row} Row */

const DEGREE = Math.PI / 180;

/** How a row's number is shown: its unit, how much of it is one of the row's, and its step.
 * @param {Row} row @returns {{unit: string, factor: number, step: number}} */
export function shownUnit(row, inDegrees = degrees.value) {
  const step = row.step || 0.01;
  const turn = inDegrees && (row.unit === "rad" || row.unit === "rad/s");
  if (!turn) return { unit: row.unit || "", factor: 1, step };
  // 0.01 rad is about half a degree; people think in whole ones.
  return { unit: row.unit === "rad" ? "°" : "°/s", factor: 1 / DEGREE, step: step * 100 };
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

/** Enter in a cell of a tree: the text is accepted, and its row has the focus again.
 * @param {HTMLElement} field */
export function leave(field) {
  const row = field.closest("[data-row]");
  if (row instanceof HTMLElement) row.focus();
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
 *   step?: (count: number) => void, settle?: () => void, grab?: (event: any) => void, mode?: string, kind?: string, title?: string}} props
 *   accept: returns why a text is refused
 *   step: changes the value by so many steps; settle: the key is up again
 *   grab: a press that may become a drag
 */
export function Field({ row, shown, accept, tab, step, settle, grab, mode, kind = "", title }) {
  // What is being typed is in the element: keys come faster than the page is drawn.
  const typing = useRef(false);
  const element = useRef(/** @type {any} */ (null));
  const why = refusals.get(row.id);
  const put = () => {
    const input = element.current;
    typing.current = false;
    if (input.value === shown) return;
    const whole = document.activeElement === input && input.selectionEnd - input.selectionStart === input.value.length;
    input.value = shown;
    if (whole) input.select();
  };
  const done = () => {
    if (!typing.current) return;
    const typed = element.current.value;
    typing.current = false;
    const refused = typed === shown ? undefined : accept(typed) || undefined;
    if (refused) put();
    refuse(row.id, refused);
  };
  useLayoutEffect(() => { if (!typing.current) put(); });
  /** @param {any} event */
  const key = (event) => {
    const ctrl = event.ctrlKey || event.metaKey;
    if (event.key === "Enter") {
      event.preventDefault();
      done();
      // A number stays in the hand: the arrow keys step it.
      if (step) element.current.select(); else leave(element.current);
    } else if (event.key === "Escape" && (typing.current || why)) {
      // The tree takes the focus back to the row.
      put();
      refuse(row.id);
    } else if (step && !ctrl && (event.key === "ArrowUp" || event.key === "ArrowDown")) {
      event.preventDefault();
      put();
      refuse(row.id);
      step((event.key === "ArrowUp" ? 1 : -1) * (event.shiftKey ? 10 : event.altKey ? 0.1 : 1));
    } else if (ctrl && event.key.toLowerCase() === "z" && !typing.current) {
      // Nothing is half typed: what was accepted is meant.
      event.preventDefault();
      act(event.shiftKey ? "edit/redo" : "edit/undo");
    }
  };
  return html`<input class=${`field ${kind}`} ref=${element} tabindex=${tab}
    aria-label=${row.name || ""} aria-invalid=${why ? "true" : undefined} title=${why || title}
    inputmode=${mode} spellcheck=${false} autocomplete="off" readonly=${row.fixed} disabled=${row.off}
    onFocus=${(/** @type {any} */ e) => e.target.select()} onMouseDown=${focusWhole} onPointerDown=${grab}
    onInput=${() => { typing.current = true; if (why) refuse(row.id); }}
    onKeyDown=${key} onKeyUp=${settle} onBlur=${() => { done(); settle?.(); }} />`;
}

/** Why a number is outside the limits of its row. @param {Row} row @param {number} value */
function outside(row, value) {
  const { unit, factor } = shownUnit(row);
  const low = row.min ?? -Infinity, high = row.max ?? Infinity;
  // A limit typed as it is shown, without all its digits, means the limit.
  const near = 0.6 * 10 ** -limitDigits(unit) / factor;
  if (value >= low - near && value <= high + near) return "";
  return `${formatNumber(value * factor, limitDigits(unit))} ${unit} is outside ${limits(row)}`;
}

/** @param {string} unit */
const limitDigits = (unit) => (unit.startsWith("°") ? 2 : 4);
/** The limits of a row as they are shown. @param {Row} row */
export function limits(row) {
  const { unit, factor } = shownUnit(row);
  const ends = [row.min ?? -Infinity, row.max ?? Infinity].map((end) =>
    (Number.isFinite(end) ? formatNumber(end * factor, limitDigits(unit)) : end < 0 ? "−∞" : "∞").replace("-", "−"));
  return `${ends[0]} … ${ends[1]} ${unit}`.trim();
}

/** How long a value that a hand has set is shown without an answer of the server [ms]. */
const ANSWER = 1000;

/** The value of a row, or the one that a hand has set until the server has it too.
 * @param {Row} row */
function useHeld(row) {
  const held = useRef(/** @type {{value: number, gesture: number, over: boolean} | null} */ (null));
  const [, again] = useState(0);
  const draw = () => again((n) => n + 1);
  if (held.current?.over && (row.value === held.current.value || refusals.has(row.id))) held.current = null;
  const release = () => {
    const mine = held.current;
    if (!mine || mine.over) return;
    mine.over = true;
    setTimeout(() => { if (held.current === mine) { held.current = null; draw(); } }, ANSWER);
    draw();
  };
  return {
    // Keys come faster than the page is drawn, so it is read when it is used.
    get value() { return held.current ? held.current.value : Number(row.value); },
    /** One of the values of a movement. @param {number} wanted in the row's unit */
    move(wanted) {
      const value = clamped(row.kind === "int" ? Math.round(wanted) : wanted, row);
      const gesture = held.current && !held.current.over ? held.current.gesture : newGesture();
      const same = value === (held.current ? held.current.value : row.value);
      held.current = { value, gesture, over: false };
      if (!same) send(row.id, value, gesture);
      draw();
    },
    release,
    /** A value that was typed. @param {number} value */
    put(value) {
      held.current = { value, gesture: 0, over: false };
      send(row.id, value);
      release();
    },
  };
}

/** @typedef {ReturnType<typeof useHeld>} Held */

/** @param {{row: Row, tab: number}} props */
export function NumberCell({ row, tab }) {
  return html`<${NumberField} row=${row} tab=${tab} held=${useHeld(row)} />`;
}

/** A number that is typed, stepped with the arrow keys or dragged sideways.
 * @param {{row: Row, tab: number, held: Held}} props */
function NumberField({ row, tab, held }) {
  degrees.use();
  const { unit, factor, step } = shownUnit(row);
  const free = !row.fixed && !row.off;
  /** @param {string} typed */
  const accept = (typed) => {
    const read = parseNumber(typed, unit);
    if ("error" in read) return read.error;
    const value = row.kind === "int" ? Math.round(read.value) : read.value;
    const why = outside(row, value);
    if (!why) held.put(clamped(value, row));
    return why;
  };
  /** @param {number} count */
  const move = (count) => {
    const fine = Math.abs(count) < 1 && row.kind !== "int";
    const times = fine ? Math.sign(count) : Math.sign(count) * Math.max(1, Math.abs(count));
    held.move(stepped(held.value * factor, fine ? step / 10 : step, times) / factor);
  };
  // The cell is drawn again while it is dragged; the drag keeps to the latest one.
  const latest = useRef(held);
  latest.current = held;
  /** @param {any} event */
  const grab = (event) => {
    const input = event.target;
    if (event.button !== 0 || event.pointerType === "touch" || document.activeElement === input) return;
    event.preventDefault();
    input.setPointerCapture(event.pointerId);
    let at = event.clientX, shown = latest.current.value * factor, moved = false;
    input.onpointermove = (/** @type {any} */ e) => {
      if (!moved && Math.abs(e.clientX - at) < 4) return;
      moved = true;
      shown += (e.clientX - at) * step * (e.shiftKey ? 10 : e.altKey ? 0.1 : 1);
      shown = clamped(shown / factor, row) * factor;
      at = e.clientX;
      latest.current.move(snapped(shown, e.altKey ? step / 10 : step) / factor);
    };
    input.onpointerup = input.onpointercancel = (/** @type {any} */ e) => {
      input.onpointermove = input.onpointerup = input.onpointercancel = null;
      if (moved) latest.current.release();
      else if (e.type === "pointerup") input.focus();
    };
  };
  return html`<span class="number">
    <${Field} row=${row} tab=${tab} kind="num" mode="decimal" accept=${accept}
      step=${free ? move : undefined} settle=${held.release} grab=${free ? grab : undefined}
      shown=${formatNumber(held.value * factor, row.kind === "slider" ? (factor === 1 ? 4 : 2) : factor === 1 ? 6 : 4)} />
    ${unit && html`<span class="unit">${unit}</span>`}
  </span>`;
}

/** A slider with its number: the row of a joint. @param {{row: Row, tab: number}} props */
export function SliderCell({ row, tab }) {
  degrees.use();
  const held = useHeld(row);
  const over = !row.wheel && (held.value < (row.min ?? -Infinity) - 1e-9 || held.value > (row.max ?? Infinity) + 1e-9);
  return html`<span class=${`slide${over ? " over" : ""}`}>
    ${row.follows ? html`<span class="formula" title=${formula(row)}>${formula(row)}</span>` : html`<${Handle} row=${row} tab=${tab} held=${held} />`}
    <${NumberField} row=${row} tab=${tab} held=${held} />
    ${row.wheel && html`<${TurnButton} row=${row} tab=${tab} />`}
  </span>`;
}

/** @param {{row: Row, tab: number, held: Held}} props */
function Handle({ row, tab, held }) {
  const { factor, step, unit } = shownUnit(row);
  const low = row.min ?? 0, high = row.max ?? 1;
  const value = held.value;
  // The ends are exact, whatever the step.
  /** @param {number} raw */
  const slide = (raw) => held.move(raw <= low ? low : raw >= high ? high : snapped(raw * factor, step) / factor);
  /** @param {any} event */
  const key = (event) => {
    const count = /** @type {Record<string, number>} */ ({
      ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: 10, PageDown: -10 })[event.key];
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (/^[\d.,+\-(]$/.test(event.key)) {
      // A number is typed into the field beside it.
      event.target.closest("[data-row]").querySelector("input.num").focus();
      return event.stopPropagation();
    }
    if (count) held.move(stepped(held.value * factor, step, count * (event.shiftKey ? 10 : 1)) / factor);
    else if (event.key === "Home") held.move(low);
    else if (event.key === "End") held.move(high);
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  return html`<input type="range" min=${low} max=${high} step="any" value=${value} tabindex=${tab}
    aria-label=${row.name || ""} disabled=${row.fixed || row.off}
    aria-valuetext=${`${formatNumber(value * factor, 3)} ${unit}`}
    onInput=${(/** @type {any} */ e) => slide(Number(e.target.value))}
    onChange=${held.release} onPointerUp=${held.release} onPointerCancel=${held.release}
    onKeyDown=${key} onKeyUp=${held.release} onBlur=${held.release} />`;
}

/** How a joint follows another one, in the units that are shown. @param {Row} row @returns {string} */
export function formula(row) {
  const leader = rows.get(row.follows);
  const { factor, unit } = shownUnit(row);
  const times = formatNumber(row.times * factor / (leader ? shownUnit(leader).factor : 1), 4);
  const plus = row.plus ? ` ${row.plus < 0 ? "−" : "+"} ${formatNumber(Math.abs(row.plus) * factor, 4)} ${unit}` : "";
  return `= ${times === "1" ? "" : `${times} × `}${leader?.name || ""}${plus}`.replace("-", "−");
}

/** Starts a wheel, or stops it. @param {{row: Row, tab: number}} props */
function TurnButton({ row, tab }) {
  const turning = (useRow("joints/turning")?.value || []).includes(row.id);
  const label = `${turning ? "Stop" : "Turn"} ${row.name}`;
  return html`<button class="flat turn" aria-pressed=${String(turning)} aria-label=${label} title=${label} tabindex=${tab}
    onClick=${() => act("joints/turn", [row.id])}><${Icon} name=${turning ? "stop" : "turn"} /></button>`;
}

/** @param {{row: Row, tab: number}} props */
function TextCell({ row, tab }) {
  return html`<${Field} row=${row} tab=${tab} shown=${String(row.value ?? "")}
    accept=${(/** @type {string} */ typed) => { send(row.id, typed); }} />`;
}

/** Several numbers in one field, as RViz writes a vector. @param {{row: Row, tab: number}} props */
function VectorCell({ row, tab }) {
  degrees.use();
  const { unit, factor } = shownUnit(row);
  const texts = row.value.map((/** @type {number} */ part) => formatNumber(part * factor, 5));
  /** @param {string} typed */
  const accept = (typed) => {
    const values = typed.split(/[;\s]+/).filter(Boolean).map((part, i) => {
      // What was not changed keeps the digits that are not shown.
      if (part === texts[i]) return row.value[i];
      const read = parseNumber(part, unit);
      return "value" in read ? read.value : NaN;
    });
    if (values.length !== row.value.length || values.some(Number.isNaN)) {
      return `type ${row.value.length} numbers, such as ${row.value.map(() => "0").join("; ")}`;
    }
    send(row.id, values);
  };
  return html`<span class="number"><${Field} row=${row} tab=${tab} shown=${texts.join("; ")} accept=${accept} />
    ${unit && html`<span class="unit">${unit}</span>`}</span>`;
}

/** @param {{row: Row, tab: number}} props */
function ColorCell({ row, tab }) {
  const hex = "#" + row.value.map((/** @type {number} */ part) => part.toString(16).padStart(2, "0")).join("");
  // All that is picked until the picker is closed is one step for undo.
  const gesture = useRef(0);
  return html`<span class="color">
    <input type="color" value=${hex} tabindex=${tab} disabled=${row.fixed || row.off}
      aria-label=${`${row.name}, choose`}
      onInput=${(/** @type {any} */ e) => send(row.id, e.target.value, gesture.current ||= newGesture())}
      onChange=${() => { gesture.current = 0; }} />
    <${Field} row=${row} tab=${tab} shown=${row.value.join("; ")}
      accept=${(/** @type {string} */ typed) => { send(row.id, typed); }} />
  </span>`;
}

/** @param {{row: Row, tab: number}} props */
function EnumCell({ row, tab }) {
  const options = row.options || [];
  if (row.editable) return html`<${ComboCell} row=${row} tab=${tab} options=${options} />`;
  const offered = options.includes(row.value) ? options : [row.value, ...options];
  return html`<select class="field" aria-label=${row.name || ""} tabindex=${tab}
      disabled=${row.fixed || row.off} value=${row.value}
      onChange=${(/** @type {any} */ e) => send(row.id, e.target.value)}>
    ${offered.map((option) => html`<option value=${option}>${option}</option>`)}
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
    tab=${tab} title=${refusals.get(row.id)} invalid=${refusals.has(row.id)} off=${row.fixed || row.off}
    accept=${(/** @type {string} */ chosen) => { refuse(row.id); send(row.id, chosen); }} leave=${leave} />`;
}

/** @param {{row: Row, tab: number}} props */
function FactCell({ row, tab }) {
  return html`<span class="fact" title=${row.kind === "fact" ? String(row.value) : undefined}>${row.value}</span>
    ${row.copy && html`<${CopyButton} row=${row} tab=${tab} />`}`;
}

/** @param {{row: Row, tab: number}} props */
export function CopyButton({ row, tab }) {
  return html`<button class="flat copy" tabindex=${tab} aria-label=${`Copy ${row.name}`} title=${`Copy ${row.name}`}
    onClick=${() => copy(String(row.value), row.name || "the text")}><${Icon} name="copy" /></button>`;
}

/** @type {Record<string, any>} */
const CELLS = {
  bool: Box, int: NumberCell, float: NumberCell, slider: SliderCell, text: TextCell,
  file: TextCell, vector: VectorCell, color: ColorCell, enum: EnumCell, frame: FrameCell,
  fact: FactCell, display: (/** @type {any} */ { row, tab }) => row.fixed ? null : html`<${Box} row=${row} tab=${tab} />`,
  status: (/** @type {any} */ { row, tab }) => (row.whole ? null : html`<${FactCell} row=${row} tab=${tab} />`),
};

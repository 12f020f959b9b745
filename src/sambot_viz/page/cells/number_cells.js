// @ts-check
/* Numbers: typed, stepped with the arrow keys, dragged sideways, or moved by a slider. */

import { html, useRef, useState } from "../vendor/preact.js";
import { act, newGesture, rows, send } from "../wire/channel.js";
import { Field } from "./field.js";
import { Slide, useFollowed } from "./followed.js";
import { goesOn } from "./key_steps.js";
import { Icon } from "../window/icons.js";
import { refusals, tell } from "../window/notices.js";
import { clamped, formatNumber, parseNumber, snapped, stepped, writtenNumber } from "./numbers.js";
import { degrees, useData } from "../state.js";
import { formula, NARROW, outside, shownNumber, shownUnit, taken, unitBeside } from "./units.js";

/** @typedef {import("../wire/rows.js").Row} Row */

/** How long a value that a hand has set is shown without an answer of the server [ms]. */
const ANSWER = 1000;

/** The value of a row, or the one that a hand has set until the server has it too.
 * @param {Row} row */
function useHeld(row) {
  // again: the row had this value already when it was set, after another; the answer to that may
  // still come. key: which has moved it.
  const held = useRef(
    /** @type {{value: number, gesture: number, over: boolean, again: boolean,
     *   key?: import("./key_steps.js").Stroke} | null} */ (null),
  );
  const [, again] = useState(0);
  const draw = () => again((n) => n + 1);
  if (held.current && row.value !== held.current.value) held.current.again = false;
  if (
    held.current?.over &&
    ((row.value === held.current.value && !held.current.again) || refusals.has(row.id))
  )
    held.current = null;
  const release = () => {
    const mine = held.current;
    if (!mine || mine.over) return;
    mine.over = true;
    setTimeout(() => {
      if (held.current === mine) {
        held.current = null;
        draw();
      }
    }, ANSWER);
    draw();
  };
  return {
    // Keys come faster than the page is drawn, so it is read when it is used.
    get value() {
      return held.current ? held.current.value : Number(row.value);
    },
    /** One of the values of a movement.
     * @param {number} wanted in the row's unit
     * @param {import("./key_steps.js").Stroke} [key] where a key moves it */
    move(wanted, key) {
      const value = clamped(row.kind === "int" ? Math.round(wanted) : wanted, row);
      const on = held.current && !held.current.over && (!key || goesOn(held.current.key, key));
      const gesture = on && held.current ? held.current.gesture : newGesture();
      const same = value === (held.current ? held.current.value : row.value);
      const again = same ? Boolean(held.current?.again) : rows.value(row.id) === value;
      held.current = { value, gesture, over: false, again, key };
      if (!same) send(row.id, value, gesture);
      draw();
    },
    release,
    /** A value that was typed. @param {number} value */
    put(value) {
      held.current = {
        value,
        gesture: 0,
        over: false,
        again: Boolean(held.current) && rows.value(row.id) === value,
      };
      send(row.id, value);
      release();
    },
  };
}

/** @typedef {ReturnType<typeof useHeld>} Held */

/** @param {{row: Row, tab: number, room?: number}} props room: how many characters fit into it */
export function NumberCell({ row, tab, room }) {
  return html`<${NumberField} row=${row} tab=${tab} held=${useHeld(row)} room=${room} />`;
}

/** A number that is typed, stepped with the arrow keys or dragged sideways.
 * @param {{row: Row, tab: number, held: Held, room?: number}} props */
function NumberField({ row, tab, held, room }) {
  degrees.use();
  const { unit, factor, step } = shownUnit(row);
  const beside = unitBeside(row, unit);
  const free = !row.fixed && !row.off;
  /** @param {string} typed */
  const accept = (typed) => {
    const read = parseNumber(typed, unit);
    if ("error" in read) return read.error;
    const { value, said } = taken(row, read.value);
    const why = outside(row, value);
    if (why) return why;
    held.put(clamped(value, row));
    if (said) tell(said, "info");
  };
  /** @param {number} count @param {Key} event */
  const move = (count, event) => {
    const fine = Math.abs(count) < 1 && row.kind !== "int";
    const times = fine ? Math.sign(count) : Math.sign(count) * Math.max(1, Math.abs(count));
    held.move(stepped(held.value * factor, fine ? step / 10 : step, times) / factor, event);
  };
  // The cell is drawn again while it is dragged; the drag keeps to the latest one.
  const latest = useRef(held);
  latest.current = held;
  /** @param {Press} event */
  const grab = (event) => {
    const input = event.target;
    if (event.button !== 0 || event.pointerType === "touch" || document.activeElement === input)
      return;
    event.preventDefault();
    input.setPointerCapture(event.pointerId);
    let at = event.clientX;
    let shown = latest.current.value * factor;
    let moved = false;
    input.onpointermove = (e) => {
      if (!moved && Math.abs(e.clientX - at) < 4) return;
      moved = true;
      shown += (e.clientX - at) * step * (e.shiftKey ? 10 : e.altKey ? 0.1 : 1);
      shown = clamped(shown / factor, row) * factor;
      at = e.clientX;
      latest.current.move(snapped(shown, e.altKey ? step / 10 : step) / factor);
    };
    input.onpointerup = input.onpointercancel = (e) => {
      input.onpointermove = input.onpointerup = input.onpointercancel = null;
      if (moved) latest.current.release();
      else if (e.type === "pointerup") input.focus();
    };
  };
  // Beside a slider there is room for few digits; the others are in the tooltip, and in the hand.
  const slider = row.kind === "slider";
  const shown = shownNumber(row, held.value, room);
  const exact = formatNumber(held.value * factor, 9);
  return html`<span class="number" data-unit=${beside || undefined}>
    <${Field} row=${row} tab=${tab} kind="num" accept=${accept}
      title=${exact === shown ? "" : exact}
      full=${slider ? exact : undefined} step=${free ? move : undefined} settle=${held.release}
        grab=${free ? grab : undefined} shown=${shown} />
  </span>`;
}

/** A slider with its number: the row of a joint, or of a number with other ends than limits. @param {{row: Row, tab: number}} props */
export function SliderCell({ row, tab }) {
  degrees.use();
  const held = useHeld(row);
  const over =
    !row.wheel &&
    (held.value < (row.min ?? -Infinity) - 1e-9 || held.value > (row.max ?? Infinity) + 1e-9);
  return html`<${Slide} look=${`slide${over ? " over" : ""}`} off=${row.off}
    joint=${row.low === undefined}>
    ${
      row.follows
        ? html`<span class="formula" title=${formula(row)}>${formula(row)}
      </span>`
        : html`<${Handle} row=${row} tab=${tab} held=${held} />`
    }
    <${NumberField} row=${row} tab=${tab} held=${held} room=${row.fixed ? NARROW - 1 : NARROW} />
    ${row.wheel && html`<${TurnButton} row=${row} tab=${tab} />`}
  <//>`;
}

/** How far a finger goes before it is known whether it slides or scrolls [px]. */
const SLOP = 8;

/** What a finger on a slider wants. A browser moves the handle to where a finger is put down, also
 * when it then scrolls the list: until it goes sideways, or is lifted, nothing counts.
 * @param {() => number} value what the slider shows @param {(raw: number) => void} slide
 * @param {() => void} release called when it is lifted */
function useFinger(value, slide, release) {
  const finger = useRef(
    /** @type {{x: number, y: number, wants: "" | "slide" | "scroll", raw: number | null} | null} */ (
      null
    ),
  );
  // The slider is drawn again while it is moved.
  const latest = useRef({ slide, release });
  latest.current = { slide, release };
  /** @param {PointerEvent} event */
  const decide = (event) => {
    const one = finger.current;
    const across = one && Math.abs(event.clientX - one.x);
    const down = one && Math.abs(event.clientY - one.y);
    if (one && !one.wants && Math.max(Number(across), Number(down)) > SLOP)
      one.wants = Number(across) > Number(down) ? "slide" : "scroll";
  };
  return {
    // Of all sliders only the one in a hand listens to more than that.
    onPointerDown: (/** @type {Press} */ { target, pointerType, clientX, clientY }) => {
      const touch = pointerType === "touch";
      finger.current = touch ? { x: clientX, y: clientY, wants: "", raw: null } : null;
      const up = () => {
        target.onpointermove = target.onpointerup = target.onpointercancel = null;
        latest.current.release();
      };
      target.onpointermove = decide;
      target.onpointerup = () => {
        const one = finger.current;
        // A tap: the handle goes there.
        if (one && !one.wants && one.raw !== null) latest.current.slide(one.raw);
        up();
      };
      target.onpointercancel = () => {
        // The browser scrolls.
        if (finger.current) finger.current.wants = "scroll";
        up();
      };
      target.ontouchend = target.ontouchcancel = () => {
        finger.current = null;
        target.ontouchend = target.ontouchcancel = null;
      };
    },
    onInput: (/** @type {Change} */ e) => {
      const one = finger.current;
      const raw = Number(e.target.value);
      if (!one || one.wants === "slide") return slide(raw);
      one.raw = raw;
      e.target.value = String(value());
    },
  };
}

/** @param {{row: Row, tab: number, held: Held}} props */
function Handle({ row, tab, held }) {
  const { factor, step, unit } = shownUnit(row);
  const low = row.low ?? row.min ?? 0;
  const high = row.high ?? row.max ?? 1;
  const value = held.value;
  // The ends are exact, whatever the step.
  /** @param {number} raw */
  const slide = (raw) =>
    held.move(raw <= low ? low : raw >= high ? high : snapped(raw * factor, step) / factor);
  const finger = useFinger(() => held.value, slide, held.release);
  /** @param {Key} event */
  const key = (event) => {
    const count = /** @type {Record<string, number>} */ ({
      ArrowRight: 1,
      ArrowUp: 1,
      ArrowLeft: -1,
      ArrowDown: -1,
      PageUp: 10,
      PageDown: -10,
    })[event.key];
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (/^[\d.,+\-(]$/.test(event.key)) {
      // A number is typed into the field beside it.
      event.target.closest("[data-row]")?.querySelector("input.num")?.focus();
      return event.stopPropagation();
    }
    if (count)
      held.move(
        stepped(held.value * factor, step, count * (event.shiftKey ? 10 : 1)) / factor,
        event,
      );
    else if (event.key === "Home") held.move(low, event);
    else if (event.key === "End") held.move(high, event);
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  // Filled from zero on; where there is no zero, from the end that is next to it.
  /** @param {number} at */
  const part = (at) => (high > low ? (Math.max(low, Math.min(high, at)) - low) / (high - low) : 0);
  const [zero, now] = [part(0), part(value)];
  const style = `--from: ${Math.min(zero, now)}; --to: ${Math.max(zero, now)}; --zero: ${zero}`;
  /** @param {number} end */
  const written = (end) => writtenNumber(end * factor, unit.startsWith("°") ? 0 : 2);
  return html`<span class=${low < 0 && high > 0 ? "track zero" : "track"} style=${style}>
    <input type="range" min=${low} max=${high} step="any" value=${value} tabindex=${tab}
    aria-label=${row.name || ""} disabled=${row.fixed || row.off}
    aria-valuetext=${`${formatNumber(value * factor, 3)} ${unit}`}
    ...${finger} onChange=${held.release}
    onKeyDown=${key} onKeyUp=${held.release} onBlur=${held.release} />
    <span class="ends" aria-hidden="true" data-low=${written(low)}
      data-high=${written(high)}></span>
  </span>`;
}

/** Starts a wheel, or stops it. @param {{row: Row, tab: number}} props */
function TurnButton({ row, tab }) {
  const turning = (useData("joints/turning") || []).includes(row.id);
  const label = `${turning ? "Stop" : "Turn"} ${row.name}`;
  // What messages move is theirs.
  const free = !useFollowed();
  return html`<button class="flat turn needs-control" disabled=${!free} aria-pressed=${String(turning)} aria-label=${label}
    title=${label} tabindex=${tab}
    onClick=${() => act("joints/turn", [row.id])}><${Icon} name=${turning ? "stop" : "turn"} />
      </button>`;
}

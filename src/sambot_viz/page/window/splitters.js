// @ts-check
/* The edges of the panels, and which are folded away. */

import { html } from "../vendor/preact.js";
import { Icon } from "./icons.js";
import { between, fitted, HALF, MOST, SMALLEST } from "./sizes.js";
import { Cell } from "../state.js";
import { rows } from "../wire/channel.js";

/** @typedef {import("./sizes.js").Chosen} Chosen */
/** @typedef {import("./sizes.js").Sizes} Sizes */

/** @type {Cell<Chosen>} */
const chosen = new Cell(/** @type {Chosen} */ ({}), "sizes");
/** Which panels are folded away. @type {Cell<Record<string, boolean>>} */
export const hidden = new Cell(/** @type {Record<string, boolean>} */ ({}), "hidden");

/** Hide all panels, or bring them back. */
export function togglePanels() {
  hidden.set({ ...hidden.value, all: !hidden.value.all });
}
/** Hide the panels at first, where the program was asked to. */
export function followFullscreen() {
  const stop = rows.listen("names/fullscreen", () => {
    if (rows.data("names/fullscreen")) hidden.set({ ...hidden.value, all: true }, false);
    stop();
  });
}
/** Width and height of the window [px]. */
export const room = new Cell({ width: innerWidth, height: innerHeight });
/**
 * "wide": panels at both sides of the view; "flat": all at one side; "tall" (a phone): below it.
 */
export const shape = new Cell(measure());

/** Touch screens need more room for the panels, and so get one side for longer. */
function measure() {
  return matchMedia("(max-width: 640px) and (orientation: portrait)").matches
    ? "tall"
    : matchMedia(
          "(max-height: 480px), (max-width: 1099px), (pointer: coarse) and (max-width: 1400px)",
        ).matches
      ? "flat"
      : "wide";
}
addEventListener("resize", () => {
  room.set({ width: innerWidth, height: innerHeight });
  shape.set(measure());
});

/** The sizes for this window, in a component. @returns {Sizes} */
export function useSizes() {
  const { width, height } = room.use();
  return fitted(chosen.use(), width, height, hidden.use());
}

/** Whether a hand has chosen the height of Views, in a component. */
export function useChosenViews() {
  return chosen.use().views !== undefined;
}

/**
 * An edge that a hand can move; arrow keys move it too.
 * @param {{side: keyof Sizes, label: string}} props
 */
export function Splitter({ side, label }) {
  const sizes = useSizes();
  const away = hidden.value;
  const sign = side === "left" ? 1 : -1;
  const across = side === "left" || side === "right" || side === "side";
  const most = () => {
    if (side === "left") return MOST * innerWidth - (away.right ? 0 : sizes.right);
    if (side === "right") return MOST * innerWidth - (away.left ? 0 : sizes.left);
    return HALF * (across ? innerWidth : innerHeight);
  };
  /** @param {number} size */
  const set = (size) => {
    /** @type {Chosen} */
    const next = { ...chosen.value, [side]: between(SMALLEST, size, most()) };
    if (side === "left" || side === "right") {
      const other = side === "left" ? "right" : "left";
      if (next[other] !== undefined && !away[other]) next[other] = sizes[other];
      next.at = innerWidth;
    }
    chosen.set(next);
  };
  /** The size before a hand changes it. @param {{currentTarget: any}} event */
  const now = ({ currentTarget }) =>
    side === "views" ? currentTarget.closest(".lower").offsetHeight : sizes[side];
  /** @param {Press} event */
  const drag = (event) => {
    const from = across ? event.clientX : event.clientY;
    const size = now(event);
    event.target.setPointerCapture(event.pointerId);
    event.target.onpointermove = (e) =>
      set(size + sign * ((across ? e.clientX : e.clientY) - from));
    event.target.onpointerup = event.target.onpointercancel = () => {
      event.target.onpointermove = null;
    };
    event.preventDefault();
  };
  /** @param {Key} event */
  const key = (event) => {
    const by = /** @type {Record<string, number>} */ ({
      ArrowRight: 16,
      ArrowUp: across ? 0 : -16,
      ArrowLeft: -16,
      ArrowDown: across ? 0 : 16,
    })[event.key];
    if (!by) return;
    set(now(event) + sign * by);
    event.preventDefault();
    event.stopPropagation();
  };
  const hide = side === "side" ? "Hide the panels" : `Hide the ${side} panels`;
  const icon =
    across &&
    html`<button class="tuck" tabindex="-1" aria-label=${hide} title=${hide}
    onClick=${() => hidden.set({ ...hidden.value, [side]: true })}>
      <${Icon} name=${side === "left" ? "fold" : "unfold"} /></button>`;
  return html`<div class=${`splitter ${across ? "across" : "down"} ${side}`}>
    <div class="grip" role="separator" tabindex="0" aria-label=${label}
    aria-orientation=${across ? "vertical" : "horizontal"} aria-valuenow=${sizes[side]}
      aria-valuemin=${SMALLEST} aria-valuemax=${Math.round(most())}
    onPointerDown=${drag} onKeyDown=${key}></div>${icon}</div>`;
}

// @ts-check
/* The line between the names and the values of a tree. */

import { html } from "../vendor/preact.js";
import { splits } from "../state.js";

/** The width of the names, as a part of the tree: limits, and the step of an arrow key. */
const LEAST = 0.15;
const MOST = 0.85;
const STEP = 0.02;

/**
 * The line between names and values; a hand or the arrow keys move it.
 * @param {{panel: string, ratio: number}} props
 */
export function Divider({ panel, ratio }) {
  /** @param {number} to */
  const set = (to) => splits.set({ ...splits.value, [panel]: Math.min(MOST, Math.max(LEAST, to)) });
  /** @param {Press} event */
  const drag = (event) => {
    const box = /** @type {HTMLElement} */ (event.target.parentElement);
    const { left } = box.getBoundingClientRect();
    event.target.setPointerCapture(event.pointerId);
    event.target.onpointermove = (e) => set((e.clientX - left) / box.clientWidth);
    event.target.onpointerup = () => {
      event.target.onpointermove = null;
    };
    event.preventDefault();
  };
  /** @param {Key} event */
  const key = (event) => {
    const by = event.key === "ArrowRight" ? STEP : event.key === "ArrowLeft" ? -STEP : 0;
    if (!by) return;
    set(ratio + by);
    event.preventDefault();
    event.stopPropagation();
  };
  return html`<div class="divider" role="separator" tabindex="0" aria-orientation="vertical"
    aria-label="Width of the names" aria-valuenow=${Math.round(ratio * 100)}
    aria-valuemin=${LEAST * 100} aria-valuemax=${MOST * 100}
    onPointerDown=${drag} onKeyDown=${key}></div>`;
}

// @ts-check
/* Validation message, beside its panel: it covers no row, is never cut off, and moves nothing. */

import { html, useLayoutEffect, useRef } from "../vendor/preact.js";

/** Room round it, how wide it is at most, and what it needs beside a panel [px]. */
const GAP = 6;
const WIDEST = 280;
const LEAST = 140;

/**
 * Shown over the view, beside its parent; where the panel is as wide as the page, above the panel.
 * @param {{text: string}} props
 */
export function ValidationMessage({ text }) {
  /** @type {Ref} */
  const element = useRef(null);
  const place = () => {
    const message = element.current;
    const panel = message.closest("aside")?.getBoundingClientRect();
    if (!panel || !message.parentElement) return;
    const at = message.parentElement.getBoundingClientRect();
    const right = innerWidth - panel.right;
    const beside = Math.max(right, panel.left) - 2 * GAP;
    const width = beside < LEAST ? panel.width - 2 * GAP : Math.min(WIDEST, beside);
    message.style.maxWidth = `${width}px`;
    const { offsetWidth, offsetHeight } = message;
    const above = beside < LEAST;
    const left = right > panel.left ? panel.right + GAP : panel.left - GAP - offsetWidth;
    const top = above ? panel.top - GAP - offsetHeight : at.top;
    const lowest = innerHeight - GAP - offsetHeight;
    message.style.left = `${above ? panel.left + GAP : left}px`;
    message.style.top = `${Math.max(GAP, Math.min(lowest, top))}px`;
  };
  useLayoutEffect(() => {
    // Nothing cuts it off there.
    element.current.showPopover?.();
    addEventListener("scroll", place, true);
    return () => removeEventListener("scroll", place, true);
  }, []);
  useLayoutEffect(place);
  return html`<span class="validation beside" role="alert" popover="manual"
    ref=${element}>${text}</span>`;
}

// @ts-check
/* Validation message, overlaid so that the layout does not shift. */

import { html, useLayoutEffect, useRef } from "../vendor/preact.js";

/**
 * Shown below its parent, or above it where there is more room.
 * @param {{text: string}} props
 */
export function ValidationMessage({ text }) {
  /** @type {Ref} */
  const element = useRef(null);
  useLayoutEffect(() => {
    const message = element.current;
    const at = /** @type {HTMLElement} */ (message.parentElement).getBoundingClientRect();
    const end = message.closest(".treebox, aside")?.getBoundingClientRect().bottom ?? innerHeight;
    message.classList.toggle(
      "higher",
      at.bottom + message.offsetHeight > Math.min(end, innerHeight),
    );
  });
  return html`<span class="validation over-rows" role="alert" ref=${element}>${text}</span>`;
}

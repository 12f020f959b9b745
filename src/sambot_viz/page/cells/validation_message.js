// @ts-check
/* Why a value was refused: over what is below its row, so that nothing moves under the hand. */

import { html, useLayoutEffect, useRef } from "../vendor/preact.js";

/**
 * Its parent is what it stands below, or above where there is more room.
 * @param {{text: string}} props
 */
export function Why({ text }) {
  const element = useRef(/** @type {any} */ (null));
  useLayoutEffect(() => {
    const why = element.current;
    const at = why.parentElement.getBoundingClientRect();
    const end = why.closest(".treebox, aside")?.getBoundingClientRect().bottom ?? innerHeight;
    why.classList.toggle("higher", at.bottom + why.offsetHeight > Math.min(end, innerHeight));
  });
  return html`<span class="why over-rows" role="alert" ref=${element}>${text}</span>`;
}

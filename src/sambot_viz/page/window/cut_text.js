// @ts-check
/* A text in a line that may be too narrow for it: a click or a tap shows all of it. */

import { html, useEffect, useLayoutEffect, useRef, useState } from "../vendor/preact.js";
import { usePressOutside } from "./menu.js";
import { place } from "./popup.js";

/** @param {{text: string, is: string, role?: string}} props is: its class for the style sheets */
export function CutText({ text, is, role }) {
  const [open, setOpen] = useState(false);
  /** @type {Ref} */
  const line = useRef(null);
  /** @type {Ref} */
  const whole = useRef(null);
  const close = () => setOpen(false);
  const toggle = () => {
    const { scrollWidth, clientWidth, scrollHeight, clientHeight } = line.current;
    // A line is a pixel higher than its box where letters have a fraction of one.
    const isCut = scrollWidth > clientWidth || scrollHeight > clientHeight + 4;
    setOpen(!open && isCut);
  };
  usePressOutside([line, whole], close, open);
  useLayoutEffect(() => {
    if (open) place(line.current, whole.current);
  });
  useEffect(() => {
    if (!open) return undefined;
    /** @param {KeyboardEvent} event */
    const key = (event) => event.key === "Escape" && close();
    addEventListener("keydown", key);
    return () => removeEventListener("keydown", key);
  }, [open]);
  useEffect(close, [Boolean(text)]);
  return html`<span class=${is} role=${role} title=${text} ref=${line} onClick=${toggle}
      >${text}</span>
    ${open && html`<div class="popped whole" role="tooltip" ref=${whole}>${text}</div>`}`;
}

// @ts-check
/* A line of text that is typed. */

import { html, useLayoutEffect, useRef } from "../vendor/preact.js";
import { act } from "../wire/channel.js";
import { refusals, refuse } from "../window/notices.js";

/** @typedef {import("../wire/rows.js").Row} Row */

/** Told to the tree when Enter has accepted the text of a row: its next key is for a tool. */
export const ACCEPTED = "accepted";

/** Enter in a cell of a tree: the text is accepted, and its row has the focus again.
 * @param {HTMLElement} field */
export function leave(field) {
  const row = field.closest("[data-row]");
  if (!(row instanceof HTMLElement)) return;
  row.focus();
  row.dispatchEvent(new CustomEvent(ACCEPTED, { bubbles: true, detail: row.dataset.row }));
}

/** The first click marks the whole text, as typing is meant to replace it. @param {Press} event */
export function focusWhole(event) {
  if (event.button === 0 && document.activeElement !== event.target) {
    event.preventDefault();
    event.target.focus();
  }
}

/** The number that was accepted by Enter and is still in the hand. @type {HTMLElement | null} */
let kept = null;

/** The hand goes to the 3D view, as its mouse does in RViz: keys are for tools again. */
export function releaseKept() {
  if (kept === document.activeElement) kept?.blur();
  kept = null;
}

/**
 * A line of text that is accepted by Enter or by leaving it, and put back by Esc.
 * @param {{row: Row, shown: string, accept: (typed: string) => string | void, tab: number,
 *   full?: string, step?: (count: number, event: Key) => void, settle?: () => void, grab?: (event: any) =>
 *   void, kind?: string, title?: string}} props
 *   accept: returns why a text is refused
 *   full: what is shown while it has the focus, when `shown` leaves something out
 *   step: changes the value by so many steps; settle: the key is up again
 *   grab: a press that may become a drag
 */
export function Field({
  row,
  shown,
  full = shown,
  accept,
  tab,
  step,
  settle,
  grab,
  kind = "",
  title,
}) {
  // What is being typed is in the element: keys come faster than the page is drawn.
  const typing = useRef(false);
  /** @type {Ref<HTMLInputElement>} */
  const element = useRef(null);
  const why = refusals.get(row.id);
  const put = () => {
    const input = element.current;
    typing.current = false;
    // A field that is removed while it has the focus loses it after it is gone from here.
    if (!input) return;
    const held = document.activeElement === input;
    const text = held ? full : shown;
    if (input.value === text) return;
    const marked = Number(input.selectionEnd) - Number(input.selectionStart);
    const whole = held && marked === input.value.length;
    input.value = text;
    if (whole) input.select();
  };
  const done = () => {
    if (!typing.current || !element.current) return;
    const typed = element.current.value;
    typing.current = false;
    const refused = typed === shown || typed === full ? undefined : accept(typed) || undefined;
    if (refused) put();
    refuse(row.id, refused);
  };
  useLayoutEffect(() => {
    if (!typing.current) put();
  });
  /** @param {Key} event */
  const key = (event) => {
    const ctrl = event.ctrlKey || event.metaKey;
    if (event.key === "Enter") {
      event.preventDefault();
      done();
      // A number stays in the hand: the arrow keys step it.
      if (step) {
        element.current.select();
        kept = element.current;
      } else leave(element.current);
    } else if (event.key === "Escape" && (typing.current || why)) {
      // The tree takes the focus back to the row.
      put();
      refuse(row.id);
    } else if (step && !ctrl && (event.key === "ArrowUp" || event.key === "ArrowDown")) {
      event.preventDefault();
      put();
      refuse(row.id);
      const times = event.shiftKey ? 10 : event.altKey ? 0.1 : 1;
      step(event.key === "ArrowUp" ? times : -times, event);
    } else if (ctrl && event.key.toLowerCase() === "z" && !typing.current) {
      // Nothing is half typed: what was accepted is meant.
      event.preventDefault();
      act(event.shiftKey ? "edit/redo" : "edit/undo");
    }
  };
  return html`<input class=${`field ${kind}`} ref=${element} tabindex=${tab}
    aria-label=${row.name || ""} aria-invalid=${why ? "true" : undefined} title=${why || title}
    spellcheck=${false} autocomplete="off" readonly=${row.fixed} disabled=${row.off}
    onFocus=${(/** @type {Change} */ e) => {
      if (!typing.current) put();
      e.target.select();
    }} onMouseDown=${focusWhole} onPointerDown=${grab}
    onInput=${() => {
      kept = null;
      typing.current = true;
      if (why) refuse(row.id);
    }}
    onKeyDown=${key} onKeyUp=${settle} onBlur=${() => {
      if (typing.current) done();
      else put();
      settle?.();
    }} />`;
}

// @ts-check
/* A button that opens a small panel below it: a menu, or a form. */

import { html, useLayoutEffect, useRef } from "../vendor/preact.js";
import { act } from "../wire/channel.js";
import { isTyping, meaning } from "./keys.js";
import { usePressOutside } from "./menu.js";
import { Cell } from "../state.js";

const EDGE = 4;

/**
 * @param {{label: any, brief?: any, name: string, role: "menu" | "dialog", title?: string,
 *   opened?: Cell<boolean>, children: (close: () => void) => any}} props
 *   label: what the button shows; brief: what it shows on a phone instead; name: what it, and the
 *   panel, is called; opened: for those who open it from elsewhere
 */
export function Popup({ label, brief, name, role, title, opened, children }) {
  const own = useRef(/** @type {Cell<boolean>} */ (new Cell(/** @type {boolean} */ (false))));
  const state = opened || own.current,
    open = state.use();
  const setOpen = (/** @type {boolean} */ on) => state.set(on);
  /** @type {Ref} */
  const button = useRef(null);
  /** @type {Ref} */
  const panel = useRef(null);
  const close = () => {
    setOpen(false);
    button.current?.focus();
  };
  useLayoutEffect(() => {
    if (open) place(button.current, panel.current);
  });
  usePressOutside([panel, button], () => setOpen(false), open);
  useLayoutEffect(() => {
    if (!open) return undefined;
    // In a form a text is to be typed; a finger would get a keyboard over the list.
    const typed = role === "dialog" && !matchMedia("(pointer: coarse)").matches;
    const first = typed && panel.current.querySelector("input");
    (first || panel.current.querySelector("button, input") || panel.current).focus();
    // The form of the time grows by itself, upwards. Another one that is placed again may get another
    // width from that, and moves what is pressed.
    const observer = new ResizeObserver(() => place(button.current, panel.current));
    if (button.current.closest(".player-bar")) observer.observe(panel.current);
    /** What had the focus may be gone. @param {KeyboardEvent} event */
    const lost = (event) => {
      if (event.key === "Escape" && document.activeElement === document.body) close();
    };
    addEventListener("keydown", lost);
    return () => {
      observer.disconnect();
      removeEventListener("keydown", lost);
    };
  }, [open]);
  /** @param {Key} event */
  const key = (event) => {
    const by = /** @type {Record<string, number>} */ ({ ArrowDown: 1, ArrowUp: -1 })[event.key];
    const does = meaning(event, []);
    const edits = typeof does === "object" && "act" in does && does.act.startsWith("edit/");
    if (event.key === "Escape") close();
    // A field with nothing in it has nothing of its own to undo.
    else if (edits && !(isTyping(event.target) && "value" in event.target && event.target.value))
      act(does.act);
    else if (by) {
      const stops = [...panel.current.querySelectorAll("button:enabled, input")];
      const at = stops.findIndex((stop) => stop === document.activeElement);
      stops[(at + by + stops.length) % stops.length]?.focus();
    } else return;
    event.preventDefault();
    event.stopPropagation();
  };
  // Who speaks to the page says what is written on the button.
  const spoken = typeof label === "string" ? `${name}: ${label}` : name;
  return html`<span class="popup">
    <button ref=${button} aria-haspopup=${role} aria-expanded=${String(open)} aria-label=${spoken}
      title=${title}
      onClick=${() => setOpen(!open)}>${
        brief ? html`<span class="brief">${brief}</span><span class="words">${label}</span>` : label
      }</button>
    ${
      open &&
      html`<div class="popped" tabindex="-1" ref=${panel} role=${role} aria-label=${name}
      onKeyDown=${key}>${children(close)}</div>`
    }
  </span>`;
}

/** Below the button, inside the window. What is in the bar below the view opens above all of it:
 * on a phone the tabs are next below it. STOP, which is above the bar, stays free. @param {HTMLElement} button @param {HTMLElement} panel */
export function place(button, panel) {
  const bar = button.closest(".player-bar");
  const at = button.getBoundingClientRect();
  const size = panel.getBoundingClientRect();
  const above = (bar || button).getBoundingClientRect().top - size.height - 2;
  const below = !bar && at.bottom + size.height + EDGE < innerHeight;
  const top = below ? at.bottom + 2 : Math.max(EDGE, above);
  const left = Math.max(EDGE, Math.min(at.left, innerWidth - size.width - EDGE));
  const stop = document.querySelector(".window > .stop-robot")?.getBoundingClientRect();
  const covers =
    stop &&
    left + size.width > stop.left &&
    left < stop.right &&
    top + size.height > stop.top &&
    top < stop.bottom;
  const beside = covers ? stop.left - size.width - EDGE : left;
  const over = covers && beside < EDGE ? stop.top - size.height - EDGE : top;
  panel.style.left = `${beside < EDGE ? left : beside}px`;
  panel.style.top = `${Math.max(EDGE, over)}px`;
}

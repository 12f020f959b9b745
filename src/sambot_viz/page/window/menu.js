// @ts-check
/* A menu at a place of the window, by mouse and by keyboard. */

import { html, useEffect, useLayoutEffect, useRef } from "../vendor/preact.js";

/**
 * @typedef {{label: string, keys?: string, off?: boolean, below?: boolean, act: () => void} | null}
 *   Item null is a line; below: it opens a menu of its own
 * @typedef {{x: number, y: number}} Place
 */

/** What a key does in a menu, on one of its entries; whether it does anything.
 * @param {any} event @param {HTMLElement[]} entries */
export function menuKey(event, entries) {
  const now = entries.indexOf(event.target);
  const last = entries.length - 1;
  if (event.ctrlKey || event.metaKey) return false;
  if (event.key === "ArrowDown") entries[now < last ? now + 1 : 0]?.focus();
  else if (event.key === "ArrowUp") entries[now > 0 ? now - 1 : last]?.focus();
  else if (event.key === "Home") entries[0]?.focus();
  else if (event.key === "End") entries[last]?.focus();
  else if (event.key === "Enter" || event.key === " ") event.target.click();
  else if (/^\w$/.test(event.key)) {
    const letter = event.key.toLowerCase();
    [...entries.slice(now + 1), ...entries]
      .find((one) => one.textContent?.trim().toLowerCase().startsWith(letter))
      ?.focus();
  } else return false;
  return true;
}

/**
 * Close what is open at a press outside of it.
 * @param {{current: HTMLElement | null}[]} elements
 * @param {() => void} close
 * @param {boolean} [open]
 */
export function usePressOutside(elements, close, open = true) {
  useEffect(() => {
    if (!open) return undefined;
    /** @param {Event} event */
    const press = (event) => {
      const at = /** @type {Node} */ (event.target);
      if (!elements.some(({ current }) => current?.contains(at))) close();
    };
    addEventListener("pointerdown", press, true);
    return () => removeEventListener("pointerdown", press, true);
  }, [open]);
}

/**
 * The menu; it closes itself. The focus then goes back to where it was.
 * @param {{items: Item[], at: Place, label: string, close: () => void, back?: () => void,
 *   first?: string}} props
 *   back: to the menu above this one; first: the label of the entry that has the focus first
 */
export function Menu({ items, at, label, close, back, first }) {
  /** @type {Ref} */
  const element = useRef(null);
  const before = useRef(document.activeElement);
  /** @type {() => HTMLElement[]} */
  const entries = () => [
    ...element.current.querySelectorAll("[role=menuitem]:not([aria-disabled])"),
  ];
  useLayoutEffect(() => {
    const { width, height } = element.current.getBoundingClientRect();
    element.current.style.left = `${Math.max(0, Math.min(at.x, innerWidth - width - 4))}px`;
    element.current.style.top = `${Math.max(0, at.y + height > innerHeight ? at.y - height : at.y)}px`;
    const all = entries();
    (all.find((one) => one.textContent?.trim() === first) ?? all[0])?.focus();
  }, []);
  usePressOutside([element], close);
  useEffect(() => {
    addEventListener("resize", close);
    return () => removeEventListener("resize", close);
  }, []);
  const end = () => {
    close();
    if (before.current instanceof HTMLElement) before.current.focus();
  };
  /** @param {Key} event */
  const key = (event) => {
    if (event.key === "Escape" || event.key === "Tab") end();
    else if (event.key === "ArrowLeft" && back) {
      end();
      back();
    } else if (event.key === "ArrowRight" && event.target.ariaHasPopup) event.target.click();
    else if (!menuKey(event, entries())) return;
    event.preventDefault();
    event.stopPropagation();
  };
  return html`<ul class="context" role="menu" aria-label=${label} ref=${element} onKeyDown=${key}
      onContextMenu=${(/** @type {Event} */ e) => e.preventDefault()}>
    ${items.map((item) =>
      item === null
        ? html`<li role="separator"></li>`
        : html`<li role="menuitem" tabindex="-1"
        aria-disabled=${item.off ? "true" : undefined}
        aria-haspopup=${item.below ? "menu" : undefined}
        onClick=${() => {
          if (!item.off) {
            end();
            item.act();
          }
        }}
        onPointerEnter=${(/** @type {Press} */ e) => {
          if (!item.off) e.target.focus();
        }}>
      <span>${item.label}</span>${item.keys && html`<kbd>${item.keys}</kbd>`}</li>`,
    )}
  </ul>`;
}

// @ts-check
/* A text with a list to choose from: typing part of a name finds it, any text may be kept. */

import { html, useLayoutEffect, useRef, useState } from "../vendor/preact.js";

const MOST = 200;
let count = 0;

/**
 * What is offered for a typed text: names that contain it, those that begin with it
 * first; then the text itself, when there is no such name.
 * @param {string[]} options @param {string | null} typed null while nothing has been typed
 * @returns {{name: string, isNew: boolean}[]}
 */
export function offers(options, typed) {
  const wanted = (typed ?? "").trim().toLowerCase();
  const found = [...new Set(options)].filter((name) => name.toLowerCase().includes(wanted));
  const rank = (/** @type {string} */ name) =>
    name.toLowerCase() === wanted ? 0 : name.toLowerCase().startsWith(wanted) ? 1 : 2;
  if (wanted) found.sort((a, b) => rank(a) - rank(b));
  const shown = found.slice(0, MOST).map((name) => ({ name, isNew: false }));
  const known = shown.length > 0 && rank(shown[0].name) === 0;
  return wanted && !known ? [...shown, { name: (typed ?? "").trim(), isNew: true }] : shown;
}

/**
 * Which of the offers Enter takes before one is marked with the arrow keys: the name that
 * was typed, the only one that contains it, else the text as it is.
 * @param {{name: string, isNew: boolean}[]} offered @param {string | null} typed
 */
export function preselected(offered, typed) {
  const wanted = (typed ?? "").trim().toLowerCase();
  if (!wanted) return -1;
  const known = offered.filter(({ isNew }) => !isNew);
  return known.length === 1 || known[0]?.name.toLowerCase() === wanted ? 0 : offered.length - 1;
}

/**
 * What Enter takes: the offer that is marked, or what an emptied field means.
 * @param {{name: string, isNew: boolean}[]} offered @param {number} at of the marked one
 * @param {string | null} typed @param {string} value as it was
 * @param {boolean} [emptiable] whether nothing is a value too
 */
export function taken(offered, at, typed, value, emptiable) {
  if (at < 0 && emptiable && typed !== null && !typed.trim()) return "";
  return offered[at]?.name ?? value;
}

/**
 * @param {{label: string, value: string, options: string[], tab: number, title?: string,
 *   invalid?: boolean, off?: boolean, emptiable?: boolean, accept: (chosen: string) => void, leave?: (field:
 *   HTMLElement) => void}} props
 *   leave: called after Enter
 */
export function Combo({
  label,
  value,
  options,
  tab,
  title,
  invalid,
  off,
  emptiable,
  accept,
  leave,
}) {
  /** @type {Ref<HTMLInputElement>} */
  const element = useRef(null);
  // What is being typed is in the element: keys come faster than the page is drawn.
  const typing = useRef(false);
  const [open, setOpen] = useState(false);
  const [, again] = useState(0);
  const marked = useRef(-1);
  const id = useRef(`combo${++count}`).current;
  const typed = () => (typing.current && element.current ? element.current.value : null);
  const offered = () => offers(options, typed());
  useLayoutEffect(() => {
    if (!typing.current) element.current.value = value;
  });
  const close = () => {
    typing.current = false;
    marked.current = -1;
    // As in a Field: one that is removed while it has the focus loses it afterwards.
    if (!element.current) return;
    element.current.value = value;
    setOpen(false);
  };
  /** @param {string} name */
  const choose = (name) => {
    close();
    if ((name || emptiable) && name !== value) accept(name);
  };
  const choice = () => (marked.current >= 0 ? marked.current : preselected(offered(), typed()));
  const meant = () => taken(offered(), choice(), typed(), value, emptiable);
  /** @param {Key} event */
  const key = (event) => {
    if (event.key === "ArrowDown" || event.key === "ArrowUp") {
      const all = offered();
      const from =
        marked.current < 0 && !typing.current
          ? all.findIndex(({ name }) => name === value)
          : choice();
      marked.current = Math.min(
        all.length - 1,
        Math.max(0, from + (event.key === "ArrowDown" ? 1 : -1)),
      );
      setOpen(true);
      again((n) => n + 1);
    } else if (event.key === "Enter") {
      choose(meant());
      leave?.(event.target);
    } else if (event.key === "Escape" && (open || typing.current)) {
      close();
      element.current.select();
    } else return;
    event.preventDefault();
    event.stopPropagation();
  };
  return html`<span class="combo">
    <input class="field" role="combobox" aria-label=${label}
      aria-expanded=${open ? "true" : "false"} ref=${element}
      aria-controls=${id} aria-autocomplete="list" tabindex=${tab} title=${title} disabled=${off}
      aria-activedescendant=${open && choice() >= 0 ? `${id}-${choice()}` : undefined}
        aria-invalid=${invalid ? "true" : undefined}
      spellcheck=${false} autocomplete="off"
      onFocus=${(/** @type {Change} */ e) => element.current.select()}
      onClick=${(/** @type {Press} */ e) => {
        if (!open) {
          setOpen(true);
          element.current.select();
        }
      }}
      onInput=${() => {
        typing.current = true;
        marked.current = -1;
        setOpen(true);
        again((n) => n + 1);
      }}
      onKeyDown=${key} onBlur=${() => (typing.current && element.current ? choose(meant()) : close())} />
    ${
      open &&
      html`<${Choices} id=${id} label=${label} of=${element} offered=${offered()}
      at=${choice()} value=${value} choose=${choose} />`
    }
  </span>`;
}

/** The list below or above the field, over all else.
 * @param {{id: string, label: string, of: {current: any}, offered: {name: string, isNew:
 *   boolean}[], at: number,
 *   value: string, choose: (name: string) => void}} props */
function Choices({ id, label, of, offered, at, value, choose }) {
  /** @type {Ref} */
  const list = useRef(null);
  useLayoutEffect(() => {
    list.current.showPopover?.();
    const box = of.current.getBoundingClientRect();
    const height = list.current.offsetHeight;
    const above = box.bottom + height > innerHeight && box.top > height;
    Object.assign(list.current.style, {
      left: `${box.left}px`,
      minWidth: `${box.width}px`,
      top: `${above ? box.top - height : box.bottom}px`,
    });
  }, [offered.length]);
  useLayoutEffect(() => {
    list.current.querySelector("[aria-selected=true]")?.scrollIntoView({ block: "nearest" });
  }, [at, offered.length]);
  /** @param {number} i */
  const isMarked = (i) => (at >= 0 ? i === at : offered[i].name === value);
  return html`<ul class="choices" role="listbox" id=${id} aria-label=${label} popover="manual"
    ref=${list} onPointerDown=${(/** @type {Press} */ e) => e.preventDefault()}>
    ${offered.map(
      ({ name, isNew }, i) => html`<li role="option" id=${`${id}-${i}`} key=${name}
      aria-selected=${isMarked(i) ? "true" : "false"}
      onClick=${() => choose(name)}
      >${isNew ? html`${name} <span class="none">not known yet</span>` : name}</li>`,
    )}
    ${!offered.length && html`<li class="none">no names yet</li>`}
  </ul>`;
}

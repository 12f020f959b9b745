// @ts-check
/* A text with a list to choose from: typing part of a name finds it, any text may be kept. */

import { html, useRef, useState } from "./vendor/preact.js";

const MOST = 200;
let count = 0;

/**
 * @param {{label: string, value: string, options: string[], tab: number, title?: string,
 *   invalid?: boolean, off?: boolean, accept: (chosen: string) => void}} props
 */
export function Combo({ label, value, options, tab, title, invalid, off, accept }) {
  const [typed, setTyped] = useState(/** @type {string | null} */ (null));
  const [at, setAt] = useState(-1);
  const [place, setPlace] = useState(/** @type {any} */ (null));
  const id = useRef(`combo${++count}`).current;
  const wanted = (typed ?? "").toLowerCase();
  const found = options.filter((option) => option.toLowerCase().includes(wanted)).slice(0, MOST);
  const open = (/** @type {any} */ input) => {
    const box = input.getBoundingClientRect();
    const above = box.bottom + 200 > innerHeight && box.top > innerHeight / 2;
    setPlace({ left: box.left, width: Math.max(box.width, 160),
      ...(above ? { bottom: innerHeight - box.top } : { top: box.bottom }) });
  };
  const close = () => { setTyped(null); setAt(-1); setPlace(null); };
  /** @param {string} chosen */
  const choose = (chosen) => { close(); if (chosen !== value) accept(chosen); };
  /** What Enter takes: the marked one, the only match, or the text as it is typed. */
  const meant = () => {
    if (at >= 0 && at < found.length) return found[at];
    const text = (typed ?? value).trim();
    if (typed === null || !text) return value;
    return options.find((option) => option.toLowerCase() === text.toLowerCase()) ?? (found.length === 1 ? found[0] : text);
  };
  /** @param {any} event */
  const key = (event) => {
    if (event.key === "ArrowDown" || event.key === "ArrowUp") {
      event.preventDefault();
      if (!place) open(event.target);
      const by = event.key === "ArrowDown" ? 1 : -1;
      const from = at < 0 && typed === null ? options.indexOf(value) : at;
      setAt(Math.min(found.length - 1, Math.max(0, from + by)));
    } else if (event.key === "Enter") { event.preventDefault(); choose(meant()); event.target.select(); }
    else if (event.key === "Escape" && place) { event.stopPropagation(); close(); }
    else return;
    event.stopPropagation();
  };
  return html`<span class="combo">
    <input class="field" role="combobox" aria-label=${label} aria-expanded=${place ? "true" : "false"}
      aria-controls=${id} aria-autocomplete="list" tabindex=${tab} title=${title} disabled=${off}
      aria-activedescendant=${at >= 0 ? `${id}-${at}` : undefined} aria-invalid=${invalid ? "true" : undefined}
      spellcheck=${false} autocomplete="off" value=${typed ?? value}
      onFocus=${(/** @type {any} */ e) => e.target.select()}
      onClick=${(/** @type {any} */ e) => { if (!place) { open(e.target); e.target.select(); } }}
      onInput=${(/** @type {any} */ e) => { setTyped(e.target.value); setAt(-1); open(e.target); }}
      onKeyDown=${key} onBlur=${() => (typed === null ? close() : choose(meant()))} />
    ${place && html`<ul class="choices" role="listbox" id=${id} aria-label=${label}
        style=${Object.entries(place).map(([key, px]) => `${key}:${px}px`).join(";")}>
      ${found.map((option, i) => html`<li role="option" id=${`${id}-${i}`} key=${option}
        aria-selected=${i === at || (at < 0 && option === value) ? "true" : "false"}
        onPointerDown=${(/** @type {any} */ e) => { e.preventDefault(); choose(option); }}>${option}</li>`)}
      ${!found.length && html`<li class="none">no such name; Enter keeps it</li>`}
    </ul>`}
  </span>`;
}

// @ts-check
/* The types of displays with a sentence each. */

import { html, useLayoutEffect, useRef } from "../vendor/preact.js";
import { rows } from "../wire/channel.js";
import { Icon } from "../window/icons.js";

/** @typedef {{kind: string, help: string}} Type */

/** "rviz_default_plugins/Axes" is "Axes". @param {string} kind */
export const nameOf = (kind) => kind.slice(kind.lastIndexOf("/") + 1);

/** @param {Type} a @param {Type} b */
const byName = (a, b) => nameOf(a.kind).localeCompare(nameOf(b.kind));

/** The types by their names. @returns {Type[]} */
export const displayTypes = () => [...(rows.data("displays/types") || [])].sort(byName);

/**
 * @param {{at: string, go: (kind: string) => void, add: () => void}} props
 *   at: the chosen type
 */
export function TypeList({ at, go, add }) {
  const shown = displayTypes();
  const list = useRef(/** @type {any} */ (null));
  const typed = useRef({ text: "", when: 0 });
  useLayoutEffect(() => {
    list.current.querySelector("[aria-selected=true]")?.scrollIntoView({ block: "nearest" });
  }, [at]);
  const index = shown.findIndex((type) => type.kind === at);
  /** @param {number} i */
  const goTo = (i) => go(shown[Math.min(shown.length - 1, Math.max(0, i))].kind);
  /** @param {KeyboardEvent} event */
  const key = (event) => {
    if (event.key === "ArrowDown") goTo(index + 1);
    else if (event.key === "ArrowUp") goTo(index - 1);
    else if (event.key === "Home") goTo(0);
    else if (event.key === "End") goTo(shown.length - 1);
    else if (event.key === "Enter") add();
    else if (/^\w$/.test(event.key) && !event.ctrlKey && !event.metaKey) find(event.key);
    else return;
    event.preventDefault();
  };
  /** Letters in quick succession find a name. @param {string} letter */
  const find = (letter) => {
    const now = Date.now();
    typed.current = {
      text: (now - typed.current.when < 1000 ? typed.current.text : "") + letter.toLowerCase(),
      when: now,
    };
    const found = shown.find((type) =>
      nameOf(type.kind).toLowerCase().startsWith(typed.current.text),
    );
    if (found) go(found.kind);
  };
  /** @param {Type} type */
  const option = (type) => html`<div role="option" id=${`add-${nameOf(type.kind)}`}
    key=${type.kind} class="option" aria-selected=${String(type.kind === at)}
      title=${type.kind} onClick=${() => go(type.kind)} onDblClick=${add}>
    <${Icon} name=${nameOf(type.kind)} /><b>${nameOf(type.kind)}</b><span>${type.help}</span>
    </div>`;
  return html`<div class="options" role="listbox" tabindex="0" aria-label="Display types" data-first
    ref=${list} onKeyDown=${key} aria-activedescendant=${at ? `add-${nameOf(at)}` : undefined}>
    ${shown.map(option)}
  </div>`;
}

// @ts-check
/* The search of a panel that the server searches: of thousands of topics the page has only the
 * rows of those that are found. */

import { html, useRef } from "../vendor/preact.js";
import { focusWhole } from "../cells/field.js";
import { useAfter, useData, useRow } from "../state.js";
import { rows } from "../wire/channel.js";
import { searchKey } from "./search.js";

/**
 * @param {{panel: string, find: (text: string) => void, first?: (text: string) => string | undefined,
 *   finds?: (row: import("../wire/rows.js").Row) => boolean}} props
 *   find: asks the server; first and finds: which row Enter goes to, as for `searchKey`
 */
export function ServerSearch({ panel, find, first, finds }) {
  useRow(`panel:${panel}`);
  const shown = useData(`${panel}/shown`);
  /** A key that waits for what is found. @type {{current: Key | null}} */
  const waits = useRef(null);
  /** @param {Key} event */
  const key = (event) => {
    const field = /** @type {HTMLInputElement} */ (event.target);
    const clear = () => {
      field.value = "";
      find("");
    };
    const gone = searchKey(event, panel, { finds, first, clear });
    waits.current = gone === false ? event : null;
  };
  useAfter(() => {
    if (waits.current) key(waits.current);
  }, [rows.panels.get(panel), shown]);
  const done = () => (waits.current = null);
  return html`<input type="search" class="search" placeholder="Search topics"
    aria-label="Search topics" autocomplete="off" spellcheck=${false} onMouseDown=${focusWhole}
    onFocus=${(/** @type {Change} */ e) => e.target.select()} onBlur=${done} onKeyDown=${key}
    onInput=${(/** @type {Change} */ e) => {
      done();
      find(e.target.value);
    }} />`;
}

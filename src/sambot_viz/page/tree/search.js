// @ts-check
/* The search of a panel: which rows are found, and the field. What is found stays where it is in
 * the tree, below the rows that it is in, and is edited there. */

import { html, useLayoutEffect, useRef } from "../vendor/preact.js";
import { focusWhole } from "../cells/field.js";
import { act, ONLINE, rows } from "../wire/channel.js";
import { Cell, useAfter, useRow } from "../state.js";
import { rowElement } from "./row_list.js";

/** @typedef {import("../wire/rows.js").Row} Row */

/** What is searched for in each panel. @type {Cell<Record<string, string>>} */
const searches = new Cell({});

/** @param {string} panel @param {string} text */
export function search(panel, text) {
  if ((searches.value[panel] || "") !== text) searches.set({ ...searches.value, [panel]: text });
}

/** The words of a search. @param {string} text */
export const wordsOf = (text) => text.toLowerCase().split(/\s+/).filter(Boolean);

/** The names of the rows above a row, from the top on. @param {Row} row @returns {string[]} */
export function namesAbove(row) {
  const above = rows.get(row.in || "");
  return above ? [...namesAbove(above), above.name || ""] : [];
}

/**
 * Whether a row is found: each word is in its name, or in one above; one at least in its own.
 * @param {Row} row @param {string[]} words
 */
export function isFound(row, words) {
  const name = (row.name || "").toLowerCase();
  if (!words.some((word) => name.includes(word))) return false;
  const path = words.every((word) => name.includes(word)) ? "" : namesAbove(row).join("\n");
  return words.every((word) => name.includes(word) || path.toLowerCase().includes(word));
}

/**
 * Whether a name has some letters in their order, and begins with the first: "drivl" is in
 * drivewhl_l_joint. @param {string} name @param {string} letters
 */
function hasLetters(name, letters) {
  if (letters.length < 3 || name[0] !== letters[0]) return false;
  let at = -1;
  return [...letters].every((letter) => (at = name.indexOf(letter, at + 1)) >= 0);
}

/** Kinds of what is in something else that has a name. */
const INSIDE = new Set(["displays", "views", "tool_properties", "drive", "selection"]);

/**
 * What the words find, the best first: the name itself, its beginning, the beginning of a word in
 * it, its letters, what is said of it; rows of their own before what is in them.
 * @template {{name: string, where: string, kind: string, words?: string}} T
 * @param {T[]} all @param {string} text @returns {T[]}
 */
export function matches(all, text) {
  const words = wordsOf(text);
  const wanted = words.join(" ");
  if (!words.length) return all;
  /** @param {T} one */
  const rank = ({ name, where, kind, words: more = "" }) => {
    const low = name.toLowerCase();
    const path = `${where} ${name}`.toLowerCase();
    const inside = INSIDE.has(kind) ? 1 : 0;
    if (!words.every((word) => path.includes(word))) {
      if (hasLetters(low, words.join(""))) return 12 + inside;
      const said = `${path} ${more.toLowerCase()}`.split(/[^\p{L}\p{N}_]+/u);
      return words.every((word) => said.some((one) => one.startsWith(word))) ? 14 + inside : -1;
    }
    if (low === wanted) return inside;
    if (low.startsWith(wanted)) return 2 + inside;
    if (words.every((word) => low.includes(word)))
      return (low.split(/[^a-z0-9]+/).some((part) => part.startsWith(words[0])) ? 4 : 6) + inside;
    return (words.some((word) => low.includes(word)) ? 8 : 10) + inside;
  };
  return all
    .map((one) => ({ one, at: rank(one) }))
    .filter(({ at }) => at >= 0)
    .sort((a, b) => a.at - b.at)
    .map(({ one }) => one);
}

/**
 * Which rows the search of a panel finds, in a component; undefined without a search.
 * @param {string} panel @param {(row: Row) => boolean} [finds] the rows that are looked for
 * @returns {((row: Row) => boolean) | undefined}
 */
export function useSearch(panel, finds = () => true) {
  const words = wordsOf(searches.use()[panel] || "");
  return words.length ? (row) => finds(row) && isFound(row, words) : undefined;
}

/** Ask for the lists that have not been sent, once there is a search: names in them count too.
 * @param {string} panel @param {string} text */
function useWholeLists(panel, text) {
  useRow(`panel:${panel}`);
  useRow(ONLINE);
  useLayoutEffect(() => {
    if (!text.trim()) return;
    for (const id of rows.panels.get(panel) || []) {
      const row = rows.get(id);
      // The facts of each link or joint are left out: they are many, and the same for all.
      if (row?.lazy && !row.entry && row.kind !== "status") act(`${panel}/unfold`, [id]);
    }
  });
}

/** The first row of a panel that a text finds; undefined for none, also without a text.
 * @param {string} panel @param {string} text @param {(row: Row) => boolean} [finds] */
export function firstFound(panel, text, finds = () => true) {
  const words = wordsOf(text);
  return rows.panels.get(panel)?.find((id) => {
    const row = rowOf(id);
    return !row.apart && finds(row) && isFound(row, words);
  });
}

/**
 * The keys of a search field: Enter and the arrow go to what is found first, the arrow without a
 * text to the first row of the panel.
 * @param {Key} event @param {string} panel
 * @param {{finds?: (row: Row) => boolean, first?: (text: string) => string | undefined,
 *   enter?: string, clear: () => void}} does
 *   first: what is found, where the names of rows do not say it; enter: what of a row has the focus
 *   after Enter
 * @returns {boolean | undefined} whether a row has the focus now; undefined for any other key
 */
export function searchKey(event, panel, { finds, first: firstOf, enter, clear }) {
  const text = /** @type {HTMLInputElement} */ (event.target).value;
  let gone;
  if (event.key === "Escape" && text) clear();
  else if (event.key === "Enter" || event.key === "ArrowDown") {
    // The text decides: keys come faster than the page is drawn.
    const first = firstOf ? firstOf(text) : firstFound(panel, text, finds);
    const any = event.key === "ArrowDown" && !text.trim() ? rows.children(`panel:${panel}`) : [];
    const id = first ?? any.find((one) => !rowOf(one).apart);
    const row = id ? rowElement(document.querySelector(`[data-panel="${panel}"]`), id) : null;
    row?.focus();
    if (enter) row?.querySelector(enter)?.focus();
    gone = Boolean(row);
  } else return undefined;
  event.preventDefault();
  event.stopPropagation();
  return gone;
}

/**
 * The field; what it finds is shown by the tree of the panel.
 * @param {{panel: string, what: string, finds?: (row: Row) => boolean, enter?: string}} props
 *   what: is searched, as "joints"; enter: what of a row has the focus after Enter
 */
export function Search({ panel, what, finds, enter }) {
  const text = searches.use()[panel] || "";
  const wanted = useSearch(panel, finds);
  /** @type {Ref<HTMLInputElement>} */
  const box = useRef(null);
  useWholeLists(panel, text);
  useLayoutEffect(() => {
    // A row that is gone to ends the search.
    if (box.current.value !== text) box.current.value = text;
  });
  useAfter(() => () => search(panel, ""), []);
  /** @param {Key} event */
  const key = (event) => searchKey(event, panel, { finds, enter, clear: () => search(panel, "") });
  const none = wanted && !rows.panels.get(panel)?.some((id) => wanted(rowOf(id)));
  return html`<input type="search" class="search" placeholder=${`Search ${what}`}
      aria-label=${`Search ${what}`} ref=${box} autocomplete="off" spellcheck=${false}
      aria-invalid=${none ? "true" : undefined} onMouseDown=${focusWhole}
      onFocus=${(/** @type {Change} */ e) => e.target.select()}
      onInput=${(/** @type {Change} */ e) => search(panel, e.target.value)} onKeyDown=${key} />`;
}

/** Says that nothing is found. @param {{panel: string, finds?: (row: Row) => boolean}} props */
export function NotFound({ panel, finds }) {
  useRow(`panel:${panel}`);
  const text = searches.use()[panel] || "";
  const wanted = useSearch(panel, finds);
  if (!wanted || rows.panels.get(panel)?.some((id) => wanted(rowOf(id)))) return null;
  const words = wordsOf(text).map((word) => `'${word}'`);
  return html`<p class="empty" role="status">${`No name has ${words.join(" and ")} in it`}</p>`;
}

/** @param {string} id */
const rowOf = (id) => /** @type {Row} */ (rows.get(id));

// @ts-check
/* The Topics panel: what there is, and why nothing of a topic is seen. */

import { html, useEffect, useRef } from "../vendor/preact.js";
import { act, rows } from "../wire/channel.js";
import { selected, useAfter, useData, useRow } from "../state.js";
import { focusWhole } from "../cells/field.js";
import { searchKey } from "../tree/search.js";
import { Tree } from "../tree/tree.js";
import { makeDisplay } from "./selected_display.js";

/** @typedef {import("../wire/rows.js").Row} Row */

/** The server searches the names of topics, not what is below them. @param {Row} row */
const isTopic = (row) => !row.in;

/** The topic that a row is of: its own, or the one that it is below. @param {Row | undefined} row */
export const topicOf = (row) => (row?.in ? rows.get(row.in) : row);

/** The search. The server searches: of thousands of topics the page has only those that are found. */
function Search() {
  useRow("panel:topics");
  /** A key that waits for what is found. @type {{current: Key | null}} */
  const waits = useRef(null);
  /** @param {Key} event */
  const key = (event) => {
    const field = /** @type {HTMLInputElement} */ (event.target);
    const clear = () => {
      field.value = "";
      act("topics/find", [""]);
    };
    const gone = searchKey(event, "topics", { finds: isTopic, clear });
    waits.current = gone === false ? event : null;
  };
  useAfter(() => {
    if (waits.current) key(waits.current);
  }, [rows.panels.get("topics")]);
  const done = () => (waits.current = null);
  return html`<input type="search" class="search" placeholder="Search topics"
    aria-label="Search topics" autocomplete="off" spellcheck=${false} onMouseDown=${focusWhole}
    onFocus=${(/** @type {Change} */ e) => e.target.select()} onBlur=${done} onKeyDown=${key}
    onInput=${(/** @type {Change} */ e) => {
      done();
      act("topics/find", [e.target.value]);
    }} />`;
}

export function TopicsPanel() {
  const shown = useData("topics/shown");
  // Ages are only looked up while somebody can see them.
  useEffect(() => {
    if (shown === false) act("topics/show", [true]);
  }, [shown]);
  useEffect(() => () => act("topics/show", [false]), []);
  const topic = topicOf(useRow(selected.use().topics || "none"));
  const kind = topic?.display;
  const name = topic?.name || "";
  useEffect(() => {
    act("topics/choose", [name]);
  }, [name]);
  const add = () => kind && makeDisplay("add-topic", [kind, name], true);
  return html`<div class="topics">
    <div class="buttons">
      <${Search} />
      <button class="needs-control" disabled=${!kind} onClick=${add}
        title="Add a display that draws the selected topic">Add display</button>
    </div>
    <${Tree} panel="topics" label="Topics" />
  </div>`;
}

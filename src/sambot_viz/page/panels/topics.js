// @ts-check
/* The Topics panel: what there is, and why nothing of a topic is seen. */

import { html, useEffect } from "../vendor/preact.js";
import { act, rows } from "../wire/channel.js";
import { selected, useData, useRow } from "../state.js";
import { focusWhole } from "../cells/field.js";
import { Tree } from "../tree/tree.js";
import { makeDisplay } from "./selected_display.js";

/** @typedef {import("../wire/rows.js").Row} Row */

export function TopicsPanel() {
  const shown = useData("topics/shown");
  // Ages are only looked up while somebody can see them.
  useEffect(() => {
    if (shown === false) act("topics/show", [true]);
  }, [shown]);
  useEffect(() => () => act("topics/show", [false]), []);
  const chosen = useRow(selected.use().topics || "none");
  const topic = chosen?.display ? chosen : rows.get(chosen?.in || "");
  const kind = topic?.display;
  const name = topic?.label || "";
  useEffect(() => {
    act("topics/choose", [name]);
  }, [name]);
  const add = () => kind && makeDisplay("add-topic", [kind, name], true);
  // The server searches: of thousands of topics the page has only those that are found.
  return html`<div class="topics">
    <div class="buttons">
      <input type="search" class="search" placeholder="Search topics" aria-label="Search topics"
        autocomplete="off" spellcheck=${false} onMouseDown=${focusWhole}
        onInput=${(/** @type {Change} */ e) => act("topics/find", [e.target.value])} />
      <button class="needs-control" disabled=${!kind} onClick=${add}
        title="Add a display that draws the selected topic">Add display</button>
    </div>
    <${Tree} panel="topics" label="Topics" />
  </div>`;
}

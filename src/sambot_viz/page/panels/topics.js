// @ts-check
/* The Topics panel: what there is, and why nothing of a topic is seen. */

import { html, useEffect } from "../vendor/preact.js";
import { act, rows } from "../wire/channel.js";
import { selected, useData, useRow } from "../state.js";
import { ServerSearch } from "../tree/server_search.js";
import { Tree } from "../tree/tree.js";
import { dragTopic } from "./display_drag.js";
import { forTopic, makeDisplay } from "./selected_display.js";

/** @typedef {import("../wire/rows.js").Row} Row */

/** The server searches the names of topics, not what is below them. @param {Row} row */
const isTopic = (row) => !row.in;

/** The topic that a row is of: its own, or the one that it is below. @param {Row | undefined} row */
export const topicOf = (row) => (row?.in ? rows.get(row.in) : row);

/** @param {string} text */
const find = (text) => act("topics/find", [text]);

export function TopicsPanel() {
  const shown = useData("topics/shown");
  // Ages are only looked up while somebody can see them.
  useEffect(() => {
    if (shown === false) act("topics/show", [true]);
  }, [shown]);
  useEffect(() => () => act("topics/show", [false]), []);
  const unasked = useData("displays/unasked");
  const topic = topicOf(useRow(selected.use().topics || "none"));
  const kind = topic?.display;
  const name = topic?.name || "";
  useEffect(() => {
    act("topics/choose", [name]);
  }, [name]);
  const add = () => kind && makeDisplay("add-topic", forTopic(name, kind), true);
  return html`<div class="topics">
    <div class="buttons">
      <${ServerSearch} panel="topics" find=${find} finds=${isTopic} />
      <button class="needs-control" disabled=${!kind} onClick=${add}
        title="Add a display that draws the selected topic">Add display</button>
    </div>
    ${
      unasked &&
      html`<button class="needs-control wide" onClick=${() => act("displays/only_config", [])}
        title="Take out the displays that were added for what is in the recording or on the robot">
        Show only what the config says</button>`
    }
    <${Tree} panel="topics" label="Topics" drag=${dragTopic} />
  </div>`;
}

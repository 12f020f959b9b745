// @ts-check
/* The topics of the source as a tree, with the displays that show them. */

import { html, useEffect, useRef, useState } from "../vendor/preact.js";
import { select, useAfter, useData } from "../state.js";
import { ServerSearch } from "../tree/server_search.js";
import { Tree } from "../tree/tree.js";
import { act, rows } from "../wire/channel.js";

/** @typedef {import("../wire/rows.js").Row} Row */

export const PANEL = "add_by_topic";
const SHOW = `${PANEL}/show`;

/** The first row that can be chosen, once the server has found what a text asks for.
 * @param {string} text */
function first(text) {
  if (rows.data(`${PANEL}/shown`)?.[0] !== text) return undefined;
  return rows.panels.get(PANEL)?.find((id) => rows.get(id)?.topic);
}

/** @param {{add: () => void}} props add: adds the display of the selected row */
export function TopicTree({ add }) {
  const [words, setWords] = useState("");
  const [all, setAll] = useState(false);
  // A server that was started again has to be asked again.
  const unknown = useData(`${PANEL}/shown`) === undefined;
  const asked = useRef("");
  useAfter(() => {
    const wanted = JSON.stringify([words, all]);
    if (!unknown && asked.current === wanted) return;
    asked.current = wanted;
    act(SHOW, [true, words, all]);
  }, [unknown, words, all]);
  useEffect(() => {
    select(PANEL, "");
    return () => act(SHOW, [false, "", false]);
  }, []);
  /** @param {Key} event @param {Row} row */
  const key = (event, row) => {
    if (event.key !== "Enter" || !row.topic) return false;
    add();
    return true;
  };
  /** @param {Row} row */
  const twice = (row) => {
    if (row.topic) add();
    return Boolean(row.topic);
  };
  return html`<div class="find">
    <${ServerSearch} panel=${PANEL} find=${setWords} first=${first} />
    <${Tree} panel=${PANEL} label="Topics and their displays" onKey=${key} onDouble=${twice} />
    <label class="line choice"><input type="checkbox" checked=${all}
      onChange=${(/** @type {Change} */ e) => setAll(e.target.checked)} />
      Show unvisualizable topics</label>
  </div>`;
}

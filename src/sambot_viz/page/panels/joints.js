// @ts-check
/* The Joints panel: a slider for each joint, and what can be done with all of them. */

import { html, useState } from "../vendor/preact.js";
import { act, rows } from "../channel.js";
import { degrees, useRow } from "../state.js";
import { Tree } from "../tree.js";

/** @typedef {import("../rows.js").Row} Row */

const SEARCH_FROM = 12;

export function JointsPanel() {
  useRow("panel:joints");
  const inDegrees = degrees.use();
  const [search, setSearch] = useState("");
  const words = search.toLowerCase().split(/\s+/).filter(Boolean);
  /** @param {Row} row */
  const wanted = (row) => row.kind === "slider" && words.every((word) => (row.name || "").toLowerCase().includes(word));
  const many = (rows.panels.get("joints") || []).length > SEARCH_FROM;
  return html`<div class="joints">
    <div class="buttons">
      <button onClick=${() => act("joints/center")} title="All joints to their start values">Center</button>
      <button onClick=${() => act("joints/randomize")} title="All joints to random values of their ranges">Randomize</button>
      <button aria-pressed=${String(inDegrees)} onClick=${() => degrees.set(!inDegrees)} title="Angles in degrees">°</button>
    </div>
    ${many && html`<input type="search" class="search" placeholder="Search joints" aria-label="Search joints" value=${search}
      onInput=${(/** @type {any} */ e) => setSearch(e.target.value)} />`}
    <${Tree} panel="joints" label="Joints" wanted=${words.length ? wanted : undefined} />
  </div>`;
}

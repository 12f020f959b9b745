// @ts-check
/* The Displays panel: the tree, what can be done with a display, and the help text. */

import { html, useState } from "../vendor/preact.js";
import { act, rows } from "../channel.js";
import { AddDisplay } from "../dialogs/add.js";
import { show } from "../dialogs/dialog.js";
import { selected, useRow } from "../state.js";
import { Tree } from "../tree.js";

/** @typedef {import("../rows.js").Row} Row */

/** The display that a row belongs to. @param {string | undefined} id @returns {Row | undefined} */
function displayOf(id) {
  let row = id ? rows.get(id) : undefined;
  while (row && !row.display) row = row.in ? rows.get(row.in) : undefined;
  return row;
}

export function DisplaysPanel() {
  const chosen = selected.use().displays;
  const row = useRow(chosen || "none");
  const [renaming, setRenaming] = useState("");
  const display = displayOf(chosen);
  /** @param {string} id @param {string | null} name null begins */
  const rename = (id, name) => {
    if (name === null) return setRenaming(id);
    setRenaming("");
    if (name.trim() && name !== rows.get(id)?.name) act("displays/rename", [id, name.trim()]);
  };
  /** @param {string} action */
  const button = (action) => display && act(`displays/${action}`, [display.id]);
  /** @param {any} event @param {Row} on */
  const key = (event, on) => {
    if (!on.display) return false;
    if (event.key === "Delete") button("remove");
    else if (event.key === "F2") rename(on.id, null);
    else return false;
    return true;
  };
  return html`<section class="panel displays" aria-label="Displays">
    <header class="title">Displays</header>
    <${Tree} panel="displays" label="Displays" onKey=${key} renaming=${renaming} rename=${rename} />
    <div class="help" aria-live="polite">${row && html`<b>${row.name}</b> ${row.help || ""}`}</div>
    <div class="buttons">
      <button onClick=${() => show(AddDisplay)}>Add</button>
      <button disabled=${!display} onClick=${() => button("duplicate")}>Duplicate</button>
      <button disabled=${!display} onClick=${() => button("remove")}>Remove</button>
      <button disabled=${!display} onClick=${() => display && rename(display.id, null)}>Rename</button>
    </div>
  </section>`;
}

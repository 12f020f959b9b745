// @ts-check
/* The Views panel: the type of view, its numbers, and the saved views. */

import { html, useLayoutEffect, useRef, useState } from "../vendor/preact.js";
import { act, rows } from "../wire/channel.js";
import { ValueCell } from "../cells/cells.js";
import { fold, isOpen, selected, useRow } from "../state.js";
import { reveal, Tree } from "../tree/tree.js";

/** @typedef {import("../wire/rows.js").Row} Row */

export function ViewsPanel() {
  useRow("panel:views");
  const type = useRow("view/type");
  const chosen = useRow(selected.use().views || "none");
  const [renaming, setRenaming] = useState("");
  const saved = chosen?.saved ? chosen : undefined;
  // A type of view with more rows than the one before would push it out of sight.
  useLayoutEffect(() => {
    if (saved) reveal("views", saved.id, false);
  }, [type?.value]);
  const use = (/** @type {Row} */ row) => act("views/use", [row.id]);
  /** @param {string} id @param {string | null} name null begins */
  const rename = (id, name) => {
    if (!rows.get(id)?.saved) return;
    if (name === null) return setRenaming(id);
    setRenaming("");
    if (name.trim() && name !== rows.get(id)?.name) act("views/rename", [id, name.trim()]);
  };
  /** @param {KeyboardEvent} event @param {Row} row */
  const key = (event, row) => {
    if (!row.saved) return false;
    if (event.key === "Enter") use(row);
    else if (event.key === "F2") rename(row.id, null);
    else if (event.key === "Delete") act("views/remove", [row.id]);
    else return false;
    return true;
  };
  /** @param {Row} row */
  const double = (row) => {
    if (row.saved) use(row);
    else if (row.id === "view") fold(row.id, !isOpen(row.id));
    return Boolean(row.saved) || row.id === "view";
  };
  return html`<section class="panel views" aria-label="Views">
    <header class="title">Views</header>
    <div class="above">
      <span aria-hidden="true">Type:</span> ${type && html`<${ValueCell} row=${type} tab=${0} />`}
      <button title="Zero (Z): reset the view to its default"
        onClick=${() => act("tools/zero")}>Zero</button>
    </div>
    <${Tree} panel="views" label="Views" onKey=${key} onDouble=${double} renaming=${renaming}
      rename=${rename} />
    <div class="buttons">
      <${Save} />
      <button disabled=${!saved} title="Go to the selected view (Enter)"
        onClick=${() => saved && use(saved)}>Go to</button>
      <button class="needs-control" disabled=${!saved} title="Remove the selected view (Delete)"
        onClick=${() => saved && act("views/remove", [saved.id])}>Remove</button>
      <button class="needs-control" disabled=${!saved} title="Rename the selected view (F2)"
        onClick=${() => saved && rename(saved.id, null)}>Rename</button>
    </div>
  </section>`;
}

/** Saves the view, and shows the new row as the selected one. */
function Save() {
  useRow("panel:views");
  const before = useRef(/** @type {Set<string> | null} */ (null));
  const saved = rows.children("panel:views").filter((id) => rows.get(id)?.saved);
  useLayoutEffect(() => {
    const made = before.current && saved.find((id) => !before.current?.has(id));
    if (!made) return;
    before.current = null;
    reveal("views", made, false);
  });
  return html`<button class="needs-control" title="Save the current view to the list" onClick=${() => {
    before.current = new Set(saved);
    act("views/save");
  }}>Save</button>`;
}

/** Tell the script that handles the mouse which view this is. */
export function tellView() {
  const mark = document.createElement("span");
  mark.hidden = true;
  document.body.append(mark);
  const told = () => {
    const view = rows.data("view/shown");
    if (!view) return;
    window.sambotViz = { ...window.sambotViz, view };
    mark.dataset.sambotView = view.kind;
  };
  rows.listen("view/shown", told);
  told();
}

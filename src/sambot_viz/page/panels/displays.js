// @ts-check
/* The Displays panel: the tree, what can be done with a display, and the help text. */

import { html, useState } from "../vendor/preact.js";
import { act, mayChange, rows } from "../wire/channel.js";
import { AddDisplay } from "../dialogs/add.js";
import { show } from "../dialogs/dialog.js";
import { isOpen, selected, useRow } from "../state.js";
import { NotFound, Search } from "../tree/search.js";
import { reveal, Tree } from "../tree/tree.js";
import { makeDisplay } from "./selected_display.js";
import { dragDisplay } from "./display_drag.js";
import { moveBy, neighbour, place } from "./display_order.js";

/** @typedef {import("../wire/rows.js").Row} Row */

const PANEL = "displays";
const add = () => {
  if (mayChange()) show(AddDisplay);
};

/** @param {Row} display */
const duplicate = (display) => makeDisplay("duplicate", [display.id], isOpen(display.id));

/** @param {Row} display */
function remove(display) {
  const next = neighbour(display);
  if (next) reveal(PANEL, next);
  act("displays/remove", [display.id]);
}

export function DisplaysPanel() {
  const chosen = selected.use()[PANEL];
  const row = useRow(chosen || "none");
  const [renaming, setRenaming] = useState("");
  const display = row?.display ? row : undefined;
  /** @param {string} id @param {string | null} name null begins */
  const rename = (id, name) => {
    if (name === null) return mayChange() && setRenaming(id);
    setRenaming("");
    if (name.trim() && name !== rows.get(id)?.name) act("displays/rename", [id, name.trim()]);
  };
  /** @param {KeyboardEvent} event @param {Row} on */
  const key = (event, on) => {
    if (!on.display || event.ctrlKey || event.metaKey) return false;
    if (event.altKey && event.key === "ArrowUp") moveBy(on.id, -1);
    else if (event.altKey && event.key === "ArrowDown") moveBy(on.id, 1);
    else if (event.altKey) return false;
    else if (event.key === "Delete") remove(on);
    else if (event.key === "F2") rename(on.id, null);
    else return false;
    return true;
  };
  /** @param {Row} on @returns {import("../window/menu.js").Item[]} */
  const menu = (on) => {
    const adding = { label: "Add…", act: add };
    if (!on.display) return [adding];
    return [
      adding,
      null,
      { label: "Duplicate", act: () => duplicate(on) },
      { label: "Rename", keys: "F2", act: () => rename(on.id, null) },
      { label: "Remove", keys: "Delete", act: () => remove(on) },
      null,
      { label: "Move up", keys: "Alt+↑", off: !place(on, -1), act: () => moveBy(on.id, -1) },
      { label: "Move down", keys: "Alt+↓", off: !place(on, 1), act: () => moveBy(on.id, 1) },
      null,
    ];
  };
  return html`<section class="panel displays" aria-label="Displays">
    <header class="title"><span>Displays</span><${Search} panel=${PANEL} what="displays" /></header>
    <${NotFound} panel=${PANEL} />
    <${Tree} panel=${PANEL} label="Displays" hover=${false} onKey=${key} menu=${menu}
      renaming=${renaming} rename=${rename} drag=${dragDisplay} />
    <div class="help" aria-live="polite">${row && html`<b>${row.name}</b> ${row.help || ""}`}</div>
    <div class="buttons">
      <button class="needs-control" onClick=${add}>Add</button>
      <button class="needs-control" disabled=${!display}
        onClick=${() => display && duplicate(display)}>Duplicate</button>
      <button class="needs-control" disabled=${!display}
        onClick=${() => display && remove(display)}>Remove</button>
      <button class="needs-control" disabled=${!display}
        onClick=${() => display && rename(display.id, null)}>Rename</button>
    </div>
  </section>`;
}

// @ts-check
/* The toolbar: RViz's tools as icon and word, undo and redo. */

import { html } from "./vendor/preact.js";
import { act, rows } from "./channel.js";
import { Icon } from "./icons.js";
import { useRow } from "./state.js";

export function Toolbar() {
  useRow("panel:tools");
  const tools = rows.children("panel:tools").filter((id) => id.startsWith("tool/"));
  return html`<header class="toolbar" role="toolbar" aria-label="Tools">
    ${tools.map((id) => html`<${ToolButton} key=${id} id=${id} />`)}
    <span class="gap"></span>
    <${EditButton} id="edit/undo" icon="undo" keys="Ctrl+Z" />
    <${EditButton} id="edit/redo" icon="redo" keys="Ctrl+Shift+Z" />
  </header>`;
}

/** @param {{id: string}} props */
function ToolButton({ id }) {
  const row = useRow(id);
  if (!row) return null;
  return html`<button class="tool" aria-pressed=${String(Boolean(row.value))} title=${`${row.name} (${row.key}): ${row.help}`}
    onClick=${() => act(id)}><${Icon} name=${row.icon} /> <span class="word">${row.name}</span></button>`;
}

/** @param {{id: string, icon: string, keys: string}} props */
function EditButton({ id, icon, keys }) {
  const row = useRow(id);
  if (!row) return null;
  const title = row.value ? `${row.name}: ${row.value} (${keys})` : `${row.name} (${keys})`;
  return html`<button class="tool" disabled=${row.off} title=${title} aria-label=${row.name} onClick=${() => act(id)}><${Icon} name=${icon} /></button>`;
}

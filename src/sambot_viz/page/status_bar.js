// @ts-check
/* The status bar: what the tool can do, and what was said last. */

import { html } from "./vendor/preact.js";
import { useNotices } from "./cells.js";
import { useRow } from "./state.js";

export function StatusBar() {
  const hint = useRow("tools/hint");
  const notice = useNotices();
  return html`<footer class="statusbar" role="status">
    <span class="hint">${hint?.value || ""}</span>
    ${notice && html`<span class=${`notice l-${notice.level}`}>${notice.text}</span>`}
  </footer>`;
}

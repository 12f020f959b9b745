// @ts-check
/* Keys for the whole window. None acts while a text is being typed. */

import { act, rows } from "./channel.js";

/** Whether what has the focus takes letters. @param {EventTarget | null} target */
export function isTyping(target) {
  return target instanceof Element && target.matches(
    "textarea, select, [contenteditable], input:not([type=checkbox]):not([type=range]):not([type=color]):not([type=radio])");
}

export function listenToKeys() {
  addEventListener("keydown", (event) => {
    if (event.defaultPrevented || event.altKey) return;
    const key = event.key.toLowerCase();
    if (event.ctrlKey || event.metaKey) {
      if (key === "z" && !isTyping(event.target)) { act(event.shiftKey ? "edit/redo" : "edit/undo"); event.preventDefault(); }
      return;
    }
    if (isTyping(event.target)) return;
    if (event.key === "Escape") return act("tools/escape");
    for (const id of rows.children("panel:tools")) {
      if (rows.get(id)?.key === key) return act(id);
    }
  });
}

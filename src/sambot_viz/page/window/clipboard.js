// @ts-check
/* Copies texts, and says so. */

import { rows } from "../wire/channel.js";
import { tell } from "./notices.js";

/** @param {string} text @param {string} said what the status bar then says */
export async function copy(text, said) {
  try {
    // Only pages from this machine or with https may use it.
    await navigator.clipboard.writeText(text);
  } catch {
    if (!copyMarked(text)) return offer(text);
  }
  tell(said);
}

/** @param {string} text @returns {boolean} whether it is copied */
function copyMarked(text) {
  const area = textArea(text);
  const before = document.activeElement;
  area.style.position = "fixed";
  document.body.append(area);
  area.select();
  const copied = document.execCommand("copy");
  area.remove();
  if (before instanceof HTMLElement) before.focus();
  return copied;
}

/** The text itself, for a hand to copy. @param {string} text */
function offer(text) {
  const dialog = document.createElement("dialog");
  const close = document.createElement("button");
  const area = textArea(text);
  close.textContent = "Close";
  close.onclick = () => dialog.close();
  dialog.setAttribute("aria-label", "Text to copy");
  dialog.className = "copy";
  dialog.append(
    "This browser does not allow the page to copy. Press Ctrl+C (\u2318C on a Mac):",
    area,
    close,
  );
  dialog.onclose = () => dialog.remove();
  (document.getElementById("sambot") || document.body).append(dialog);
  dialog.showModal();
  area.select();
}

/** @param {string} text */
function textArea(text) {
  const area = document.createElement("textarea");
  area.value = text;
  area.readOnly = true;
  area.setAttribute("aria-label", "Text to copy");
  return area;
}

// What the server has written for the clipboard.
rows.listen("notice", () => {
  const said = rows.data("notice");
  if (said?.copy) void copy(said.copy, `Copied: ${said.text}`);
});

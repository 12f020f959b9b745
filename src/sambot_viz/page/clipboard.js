// @ts-check
/* Copies texts, and says so. */

import { tell } from "./notices.js";

/** @param {string} text @param {string} what how the status bar calls it */
export async function copy(text, what) {
  try {
    // Only pages from this machine or with https may use it.
    if (navigator.clipboard) await navigator.clipboard.writeText(text); else copyMarked(text);
    tell(`Copied: ${what}`);
  } catch {
    tell("The browser did not allow copying. Mark the text and press Ctrl+C.", "error");
  }
}

/** @param {string} text */
function copyMarked(text) {
  const area = document.createElement("textarea");
  const before = document.activeElement;
  area.value = text;
  area.style.position = "fixed";
  document.body.append(area);
  area.select();
  const copied = document.execCommand("copy");
  area.remove();
  if (before instanceof HTMLElement) before.focus();
  if (!copied) throw new Error("not copied");
}

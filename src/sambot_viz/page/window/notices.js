// @ts-check
/* Sentences for this browser, from the server or from the page itself, and why values
 * were refused. */

import { EDITED, edited, FOLLOWS, NOT_DONE, rows, WATCHING } from "../wire/channel.js";
import { Cell } from "../state.js";

/**
 * @typedef {{text: string, level: string, row?: string}} Notice row: the one that has refused a
 *   value
 */

/** The sentence that the status bar shows. @type {Cell<Notice | null>} */
export const notice = new Cell(/** @type {Notice | null} */ (null));

/** Show a sentence in the status bar. @param {string} text @param {string} [level] */
export function tell(text, level = "ok") {
  notice.set({ text, level });
}

/**
 * Why the last value was refused, by the id of its row, until the next edit.
 * @type {Map<string, string>}
 */
export const refusals = new Map();

/** Stops waiting for the end of the row that has refused a value. */
let unlisten = () => {};

/** @param {string} id @param {string} [why] */
export function refuse(id, why) {
  const told = [...refusals.keys()];
  // What was refused before is over.
  if (notice.value?.row && notice.value.text !== why) notice.set(null);
  refusals.clear();
  unlisten();
  if (why) {
    refusals.set(id, why);
    rows.putBack(id);
  }
  for (const other of new Set([...told, id])) rows.notify(other);
  // A row that is gone refuses nothing; another of its name may come.
  if (why && rows.get(id)) unlisten = rows.listen(id, () => rows.get(id) || refuse(id));
}

/**
 * Say why something was refused, at its place and in the status bar.
 * @param {string} id
 * @param {string} why
 */
export function sayRefused(id, why) {
  notice.set({ text: why, level: "error", row: id });
  refuse(id, why);
}

/** Typing, Tab and Escape end a refusal too. @param {Event & {key?: string}} event */
const ended = (event) => {
  if (event.type !== "input" && event.key !== "Tab" && event.key !== "Escape") return;
  for (const id of [...refusals.keys()]) refuse(id);
};
// A field that Tab leaves may refuse what was typed: that comes after this. A field that is typed
// into hears of it first, or it would put its old text back.
globalThis.addEventListener?.("keydown", ended, true);
globalThis.addEventListener?.("input", ended);

/** The part of the window in which something was done when the sentence was said. */
let saidIn = "";
/** What an edit belongs to, as "drive" for all buttons and speeds of Drive. @param {string} id */
const partOf = (id) => id.split("/")[0];
notice.listeners.add(() => {
  saidIn = partOf(edited());
});

// The next edit is the answer to a refusal; if it is refused too, the server says so again. What
// was said of an edit before is no longer what was done last, unless it is the same that goes on:
// a robot is driven by one call after the other. Warnings stay for their time.
rows.listen(EDITED, () => {
  const { level = "" } = notice.value || {};
  if (["ok", "info"].includes(level) && partOf(edited()) !== saidIn) notice.set(null);
  const refused = notice.value?.row || [...refusals.keys()][0];
  if (refused) refuse(refused);
});

rows.listen(NOT_DONE, () => tell("Not done: there is no connection", "error"));

rows.listen(WATCHING, () =>
  tell(
    rows.data(FOLLOWS)
      ? "View only: request control in the page of the origin"
      : "View only: request control, or open your own copy",
    "warn",
  ),
);

rows.listen("notice", () => {
  const said = rows.data("notice");
  if (!said || said.copy) return;
  if (said.row) sayRefused(said.row, said.text);
  else notice.set(said);
});

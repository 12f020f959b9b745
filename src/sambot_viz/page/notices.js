// @ts-check
/* Sentences for this browser, from the server or from the page itself, and why values
 * were refused. */

import { EDITED, NOT_DONE, rows } from "./channel.js";
import { Cell } from "./state.js";

/** @typedef {{text: string, level: string, row?: string}} Notice row: the one that has refused a value */

/** The sentence that the status bar shows. @type {Cell<Notice | null>} */
export const notice = new Cell(/** @type {Notice | null} */ (null));

/** Show a sentence in the status bar. @param {string} text @param {string} [level] */
export function tell(text, level = "ok") { notice.set({ text, level }); }

/** Why the last value was refused, by the id of its row, until the next edit. @type {Map<string, string>} */
export const refusals = new Map();

/** @param {string} id @param {string} [why] */
export function refuse(id, why) {
  const told = [...refusals.keys()];
  // What the server has refused elsewhere is over.
  if (why && notice.value?.row && notice.value.row !== id) notice.set(null);
  refusals.clear();
  if (why) {
    refusals.set(id, why);
    rows.putBack(id);
  }
  for (const other of new Set([...told, id])) rows.notify(other);
}

// The next edit is the answer to a refusal; if it is refused too, the server says so again.
rows.listen(EDITED, () => {
  if (notice.value?.row) notice.set(null);
  const [refused] = refusals.keys();
  if (refused) refuse(refused);
});

rows.listen(NOT_DONE, () => tell("Not done: there is no connection", "error"));

rows.listen("notice", () => {
  const said = rows.value("notice");
  if (!said || said.copy?.length) return;
  notice.set(said);
  if (said.row) refuse(said.row, said.text);
});

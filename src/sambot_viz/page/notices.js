// @ts-check
/* Sentences for this browser, from the server or from the page itself, and why values
 * were refused. */

import { rows } from "./channel.js";
import { Cell } from "./state.js";

/** @typedef {{text: string, level: string}} Notice */

/** The sentence that the status bar shows. @type {Cell<Notice | null>} */
export const notice = new Cell(/** @type {Notice | null} */ (null));

/** Show a sentence in the status bar. @param {string} text @param {string} [level] */
export function tell(text, level = "ok") { notice.set({ text, level }); }

/** Why the last value was refused, by the id of its row, until the next edit. @type {Map<string, string>} */
export const refusals = new Map();

/** @param {string} id @param {string} [why] */
export function refuse(id, why) {
  const told = [...refusals.keys()];
  refusals.clear();
  if (why) {
    refusals.set(id, why);
    rows.putBack(id);
  }
  for (const other of new Set([...told, id])) rows.notify(other);
}

rows.listen("notice", () => {
  const said = rows.value("notice");
  if (!said || said.copy?.length) return;
  notice.set(said);
  if (said.row) refuse(said.row, said.text);
});

// @ts-check
/* Displays that this page makes: they are selected as soon as they are there. */

import { act, rows } from "../wire/channel.js";
import { fold } from "../state.js";
import { reveal } from "../tree/tree.js";

/** How long the server may take [ms]. */
const PATIENCE = 10000;

/**
 * Do what makes a display, and go there; other pages that show the robot do not.
 * @param {"add" | "duplicate"} what @param {any[]} args @param {boolean} open whether it is
 *   unfolded
 */
export function makeDisplay(what, args, open) {
  const mark = Math.random().toString(36).slice(2);
  const stop = rows.listen("displays/made", () => {
    const made = rows.data("displays/made");
    if (made?.mark !== mark) return;
    stop();
    fold(made.row, open);
    reveal("displays", made.row);
  });
  setTimeout(stop, PATIENCE);
  act(`displays/${what}`, [...args, mark]);
}

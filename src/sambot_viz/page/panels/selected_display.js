// @ts-check
/* Displays that are selected, in this page alone, as soon as they are there: those that it
 * makes, and those that its Undo or Redo has touched. */

import { act, rows } from "../wire/channel.js";
import { fold } from "../state.js";
import { reveal } from "../tree/tree.js";

const PANEL = "displays";
/** How long the server and the rows of the displays may take [ms]. */
const PATIENCE = 10000;

/** What `displays/add-topic` takes, before its mark.
 * @param {string} topic @param {string} [kind] of the display; the usual one without it
 * @param {string} [name] @param {import("./display_order.js").Place} [place] the end without it
 * @returns {any[]} */
export const forTopic = (topic, kind = "", name = "", place) => [
  kind,
  topic,
  name,
  place?.group || "",
  place?.index ?? null,
];

/**
 * Do what makes a display, and go there; other pages that show the robot do not.
 * @param {"add" | "add-topic" | "duplicate"} what @param {any[]} args @param {boolean} open whether it is
 *   unfolded
 */
export function makeDisplay(what, args, open) {
  const mark = Math.random().toString(36).slice(2);
  const stop = rows.listen("displays/made", () => {
    const made = rows.data("displays/made");
    if (made?.mark !== mark) return;
    stop();
    fold(made.row, open);
    reveal(PANEL, made.row);
  });
  setTimeout(stop, PATIENCE);
  act(`displays/${what}`, [...args, mark]);
}

/**
 * Select the display when its row is there; the focus goes to it only from another row, or
 * from nothing.
 * @param {string} id */
function go(id) {
  const at = document.activeElement;
  const free = !at || at === document.body || Boolean(at.closest(`[data-panel="${PANEL}"]`));
  reveal(PANEL, id, free);
}

rows.listen("edit/touched", () => {
  const id = rows.data("edit/touched")?.row;
  if (!id) return;
  if (rows.get(id)) return go(id);
  const stop = rows.listen(`panel:${PANEL}`, () => {
    if (rows.get(id)) {
      stop();
      go(id);
    }
  });
  setTimeout(stop, PATIENCE);
});

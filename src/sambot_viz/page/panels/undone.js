// @ts-check
/* After Undo and Redo the display they have touched is selected, in this page alone. */

import { rows } from "../wire/channel.js";
import { reveal } from "../tree/tree.js";

const PANEL = "displays";
/** How long the rows of the displays may take after those of this browser [ms]. */
const PATIENCE = 10000;

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

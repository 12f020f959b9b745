// @ts-check
/* The selected rows of a page whose server was started again. */

import { select } from "../state.js";
import { rows } from "../wire/channel.js";
import { reveal } from "./tree.js";

/** How long a row may take that has to be unfolded first [ms]. */
const PATIENCE = 5000;

/** Select rows as soon as they are there, until a hand selects others.
 * @param {Record<string, string>} chosen by the names of their panels
 * @param {(id: string) => string | null} idNow */
export function selectAgain(chosen, idNow) {
  /** @type {(() => void)[]} */
  const stops = [];
  const end = () => {
    for (const stop of stops) stop();
    for (const kind of ["pointerdown", "keydown"]) removeEventListener(kind, end, true);
  };
  for (const [panel, before] of Object.entries(chosen)) {
    const id = idNow(before);
    if (!id) continue;
    const go = () => {
      if (!rows.get(id)) return;
      const has = document.activeElement?.closest(`[data-panel="${panel}"]`);
      if (has) reveal(panel, id);
      else select(panel, id);
    };
    go();
    stops.push(rows.listen(id, go));
  }
  for (const kind of ["pointerdown", "keydown"]) addEventListener(kind, end, true);
  setTimeout(end, PATIENCE);
}

// @ts-check
/* A double click on a link in the view goes to the row of its joint, or to its text. */

import { reveal } from "../tree/tree.js";
import { act, rows } from "../wire/channel.js";
import { tell } from "./notices.js";
import { openPanel } from "./panels.js";

/** Go to the joint of a link that is clicked on twice. */
export function followClickedLink() {
  let seen = rows.data("tools/pointed")?.number || 0;
  rows.listen("tools/pointed", () => {
    const { number = 0, link, row } = rows.data("tools/pointed") || {};
    const before = seen;
    seen = number;
    if (number <= before || !link) return;
    // Beside the text, its lines are what is asked for.
    if (rows.data("model/shown")) return act("model/find", [link]);
    if (!row) tell(`No joint moves ${link}`, "info");
    else if (rows.get(row)) {
      openPanel("joints");
      reveal("joints", row);
    }
  });
}

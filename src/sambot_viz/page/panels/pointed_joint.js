// @ts-check
/* Between a joint's row and its link in the view: the row that is pointed at lights the link, and a
 * double click on a link goes to its row. */

import { Cell, useAfter } from "../state.js";
import { reveal } from "../tree/tree.js";
import { glow } from "../view/drawn_here.js";
import { tell } from "../window/notices.js";
import { openPanel } from "../window/panels.js";
import { rows } from "../wire/channel.js";

/** The row under the mouse, or reached by keyboard. @type {Cell<string>} */
export const hovered = new Cell("");

hovered.listeners.add(() => glow(rows.data("joints/links")?.[hovered.value]));

/** @param {any} event */
const rowAt = (event) => event.target.closest("[data-row]")?.dataset.row || "";

/** What the list of the joints listens to. */
export const pointing = {
  onPointerOver: (/** @type {Press} */ event) => hovered.set(rowAt(event)),
  onPointerLeave: () => hovered.set(""),
  onfocusin: (/** @type {Press} */ event) => {
    if (event.target.matches(":focus-visible")) hovered.set(rowAt(event));
  },
  onfocusout: () => hovered.set(""),
};

/** End the glow with the panel, in a component. */
export const useGlowEnd = () => useAfter(() => () => hovered.set(""), []);

/** Go to the joint of a link that is clicked on twice. */
export function followPointedJoint() {
  let seen = rows.data("tools/pointed")?.number || 0;
  rows.listen("tools/pointed", () => {
    const { number = 0, link, row } = rows.data("tools/pointed") || {};
    const before = seen;
    seen = number;
    if (number <= before || !link) return;
    if (!row) tell(`No joint moves ${link}`, "info");
    else if (rows.get(row)) {
      openPanel("joints");
      reveal("joints", row);
    }
  });
}

// @ts-check
/* The row of a joint that is pointed at lights its link in the view. */

import { Cell, useAfter } from "../state.js";
import { glow } from "../view/drawn_here.js";
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

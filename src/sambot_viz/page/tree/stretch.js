// @ts-check
/* Rows of a list that stand one after the other. Out of sight they are one element with their
 * texts, a line for each and as high as they: a list of any length has few elements, and the
 * browser's Find and screen readers reach all that is in it. */

import { set } from "./row_element.js";

/** @typedef {import("./slot.js").Slot} Slot */

/** How many rows are in one. */
export const LENGTH = 25;
/** Before a line for each level above it: an em space, which a reader does not say. */
const INDENT = "\u2003";

export class Stretch {
  constructor() {
    /** @type {Slot[]} */
    this.slots = [];
    /** What is there in place of its rows. @type {HTMLElement | null} */
    this.element = null;
    /** What that says. */
    this.text = "";
    /** How high it is, for a style sheet. */
    this.high = "";
  }

  /** Whether its rows have elements of their own. */
  get isOpen() {
    return this.slots.some(({ element }) => element);
  }

  /** What is in the document for it. @returns {HTMLElement[]} */
  get elements() {
    if (!this.isOpen) return [(this.element ||= lines())];
    this.remove();
    return this.slots.map((slot) => slot.make());
  }

  /** Leave the texts of its rows. */
  close() {
    for (const slot of this.slots) slot.drop();
  }

  /** Bring its texts, or those of its rows, up to date. */
  say() {
    if (!this.element) {
      for (const slot of this.slots) if (slot.isStale && !slot.isWhole) slot.say();
      return;
    }
    const texts = this.slots.map(({ depth, text }) => INDENT.repeat(depth) + text);
    const before = this.text;
    this.text = texts.join("\n");
    const cell = /** @type {HTMLElement} */ (this.element.firstElementChild);
    if (this.text !== before) cell.textContent = this.text;
    set(this.element, "aria-rowindex", String(this.slots[0].drawn.facts.row));
    this.size();
  }

  /** Make it as high as its rows: as they were drawn, else as high as a line of their kind. */
  size() {
    if (!this.element) return;
    const undrawn = this.slots.filter(({ height }) => !height);
    const sliders = undrawn.filter(({ isSlider }) => isSlider).length;
    const drawn = this.slots.reduce((sum, { height }) => sum + height, 0);
    const lines = `${undrawn.length - sliders} * var(--row) + ${sliders} * var(--slider)`;
    const high = `calc(${lines} + ${drawn}px)`;
    if (this.high === high) return;
    this.high = high;
    this.element.style.setProperty("--high", high);
    this.element.style.setProperty("--count", String(this.slots.length));
  }

  /** Where one of its rows is, while they are texts. @param {Slot} slot */
  place(slot) {
    const { top = 0, height = 0 } = this.element?.getBoundingClientRect() || {};
    const one = height / this.slots.length;
    const at = this.slots.indexOf(slot);
    return { top: top + at * one, bottom: top + (at + 1) * one };
  }

  remove() {
    this.element?.remove();
    this.element = null;
    this.text = this.high = "";
  }
}

/** An element for lines of text: a row with one cell. */
function lines() {
  const element = document.createElement("div");
  element.className = "lines";
  element.setAttribute("role", "row");
  const cell = document.createElement("span");
  cell.setAttribute("role", "gridcell");
  element.append(cell);
  return element;
}

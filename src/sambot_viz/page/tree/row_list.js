// @ts-check
/* The rows of a tree in the document. Of a long list only the rows in sight are drawn whole; each
 * other one is an element with its text, as high as before. A row that has the focus is never
 * moved in the document, as it would lose it, and half typed text with it; the others are put
 * round it. */

import { render } from "../vendor/preact.js";
import { rows } from "../wire/channel.js";
import { refusals } from "../window/notices.js";
import { degrees } from "../state.js";
import { dress, isPlain } from "./row_element.js";
import { lineText } from "./row_text.js";
import { Sight } from "./sight.js";

/** @typedef {import("./row_element.js").Facts} Facts */
/** @typedef {{id: string, facts: Facts, view: () => any}} Drawn
 *   facts: what the row is drawn from, beside itself; view: what is in its element */

/** How long nothing changes before the texts of rows out of sight are brought up to date [ms]. */
const REST = 500;

/** A row in the document. */
class Slot {
  /** @param {Drawn} drawn @param {(slot: Slot) => void} changed */
  constructor(drawn, changed) {
    this.id = drawn.id;
    this.drawn = drawn;
    /** What it was drawn from. */
    this.facts = "";
    this.isWhole = false;
    /** Whether the text that it has while it is not drawn whole may be an old one. */
    this.isStale = true;
    this.element = document.createElement("div");
    this.element.className = "line";
    this.element.dataset.row = this.id;
    this.element.setAttribute("role", "row");
    this.stop = rows.listen(this.id, () => changed(this));
  }

  /** Whether it is drawn whole also out of sight. */
  get isKept() {
    const row = rows.get(this.id);
    const { current, chosen, renaming } = this.drawn.facts;
    return current || chosen || renaming || refusals.has(this.id) || Boolean(row && !isPlain(row));
  }

  dress() {
    const row = rows.get(this.id);
    if (row) dress(this.element, row, this.drawn.facts);
  }

  /** Draw it whole, again where its facts are others. */
  draw() {
    if (!this.isWhole) this.element.replaceChildren();
    this.isWhole = true;
    this.element.classList.remove("line");
    this.element.style.minHeight = "";
    render(this.drawn.view(), this.element);
  }

  /** Leave its text. @param {number} height as it was drawn [px] */
  shrink(height) {
    render(null, this.element);
    this.isWhole = false;
    this.element.classList.add("line");
    this.element.style.minHeight = `${height}px`;
    this.isStale = true;
  }

  /** Show the text of a row that is not drawn whole. */
  say() {
    const row = rows.get(this.id);
    const cell = this.element.firstElementChild || document.createElement("span");
    if (!cell.isConnected) this.element.append(cell);
    cell.setAttribute("role", "gridcell");
    if (row) cell.textContent = lineText(row);
    this.isStale = false;
  }

  remove() {
    this.stop();
    if (this.isWhole) render(null, this.element);
    this.element.remove();
  }
}

export class RowList {
  /** @param {HTMLElement} host */
  constructor(host) {
    this.host = host;
    /** In the order in which they are shown. @type {Slot[]} */
    this.slots = [];
    /** @type {Map<string, Slot>} */
    this.byId = new Map();
    /** The row that was pressed last: what a hand holds stays. */
    this.pressed = "";
    this.sight = new Sight(
      host,
      () => this.look(),
      () => this.forgetHeights(),
    );
    this.timer = 0;
    this.changes = 0;
    const all = () => this.slots.forEach((slot) => this.change(slot));
    degrees.listeners.add(all);
    const stop = rows.listen("displays/paths", all);
    this.stop = () => {
      degrees.listeners.delete(all);
      stop();
    };
  }

  /**
   * Show rows in an order; those whose facts are as before are left alone.
   * @param {Drawn[]} shown
   */
  show(shown) {
    const wanted = new Set(shown.map(({ id }) => id));
    for (const slot of this.slots) {
      if (wanted.has(slot.id)) continue;
      slot.remove();
      this.byId.delete(slot.id);
    }
    this.slots = shown.map((drawn) => this.slot(drawn));
    // A row is drawn in its place: what it shows over all else must be in the document.
    this.order(this.slots.map(({ element }) => element));
    this.slots.forEach((slot, at) => {
      const facts = JSON.stringify(shown[at].facts);
      slot.drawn = shown[at];
      if (slot.facts === facts) return;
      slot.facts = facts;
      slot.dress();
      if (slot.isWhole || slot.isKept) slot.draw();
    });
    this.look();
  }

  /** @param {Drawn} drawn */
  slot(drawn) {
    const slot = this.byId.get(drawn.id) || new Slot(drawn, (one) => this.change(one));
    this.byId.set(drawn.id, slot);
    return slot;
  }

  /** @param {HTMLElement[]} elements */
  order(elements) {
    const focused = elements.findIndex((element) => element.contains(document.activeElement));
    for (let i = focused; i > 0; i--) {
      if (elements[i].previousSibling !== elements[i - 1]) elements[i].before(elements[i - 1]);
    }
    for (let i = Math.max(0, focused); i < elements.length; i++) {
      if (i === 0 && this.host.firstChild !== elements[0]) this.host.prepend(elements[0]);
      const next = elements[i + 1];
      if (next && elements[i].nextSibling !== next) elements[i].after(next);
    }
  }

  /** Draw the rows whole that are in sight or in a hand, and of each other one its text. */
  look() {
    const { slots } = this;
    const elements = slots.map(({ element }) => element);
    const [first, end] = this.sight.of(elements);
    const at = document.activeElement;
    /** @param {Slot} slot */
    const isHeld = ({ id, element, isKept }) =>
      isKept || id === this.pressed || element.contains(at);
    const wanted = slots.map((slot, i) => (i >= first && i < end) || isHeld(slot));
    const leave = slots.filter(({ isWhole }, i) => isWhole && !wanted[i]);
    const heights = leave.map(({ element }) => element.offsetHeight);
    leave.forEach((slot, i) => slot.shrink(heights[i]));
    slots.forEach((slot, i) => {
      if (wanted[i]) this.touch(slot.id);
      else if (slot.isStale) slot.say();
    });
  }

  /** Draw a row whole, before the focus or a hand is in it. @param {string} id */
  touch(id) {
    const slot = this.byId.get(id);
    if (slot && !slot.isWhole) slot.draw();
  }

  /** A row is pressed: it is drawn whole until another one is. @param {string} id */
  press(id) {
    this.pressed = id;
    this.touch(id);
  }

  /** A row has changed; what is drawn whole draws its cells itself. @param {Slot} slot */
  change(slot) {
    if (slot.isWhole || refusals.has(slot.id)) {
      slot.dress();
      return this.touch(slot.id);
    }
    slot.isStale = true;
    this.changes += 1;
    if (!this.timer) this.wait();
  }

  /** Bring the texts up to date as soon as nothing has changed for a moment. */
  wait() {
    const { changes } = this;
    this.timer = setTimeout(() => {
      if (changes !== this.changes) return this.wait();
      this.timer = 0;
      for (const slot of this.slots) if (slot.isStale) slot.dress();
      this.look();
    }, REST);
  }

  /** Rows that are drawn whole again have other heights. */
  forgetHeights() {
    for (const { element } of this.slots) element.style.minHeight = "";
  }

  /** Take all rows out. */
  clear() {
    this.show([]);
    this.sight.end();
    this.stop();
    clearTimeout(this.timer);
  }
}

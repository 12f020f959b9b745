// @ts-check
/* The rows of a tree in the document. Of a long list only the rows in sight are drawn whole; each
 * other one is a line of text: near them in an element of its own, else in that of its stretch. A
 * row that has the focus is never moved in the document, as it would lose it, and half typed text
 * with it; the others are put round it. */

import { rows } from "../wire/channel.js";
import { refusals } from "../window/notices.js";
import { degrees } from "../state.js";
import { Sight } from "./sight.js";
import { Slot } from "./slot.js";
import { LENGTH, Stretch } from "./stretch.js";

/** @typedef {import("./slot.js").Drawn} Drawn */

/** How long nothing changes before the texts of rows out of sight are brought up to date [ms]. */
const REST = 500;

/** The lists by their trees. @type {WeakMap<Element, Pick<RowList, "touch" | "place">>} */
export const lists = new WeakMap();

/** The element of a row that is shown, also of one out of sight: it is drawn whole for a moment.
 * @param {Element | null} tree @param {string} id @returns {HTMLElement | null} */
export const rowElement = (tree, id) => (tree && lists.get(tree)?.touch(id)) || null;

/** Where a row is that is shown, also one out of sight; null for any other.
 * @param {Element} tree @param {string} id */
export const rowPlace = (tree, id) => lists.get(tree)?.place(id) || null;

export class RowList {
  /** @param {HTMLElement} host */
  constructor(host) {
    this.host = host;
    lists.set(host, this);
    /** In the order in which they are shown. @type {Slot[]} */
    this.slots = [];
    /** The same, so many at a time. @type {Stretch[]} */
    this.stretches = [];
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
      slot.end();
      this.byId.delete(slot.id);
    }
    this.slots = shown.map((drawn) => this.slot(drawn));
    this.divide();
    // A row is drawn in its place: what it shows over all else must be in the document.
    this.order();
    this.slots.forEach((slot, at) => {
      const facts = JSON.stringify(shown[at].facts);
      slot.drawn = shown[at];
      if (slot.facts === facts) return;
      slot.facts = facts;
      slot.isStale = true;
      slot.dress();
      if (slot.isWhole) slot.draw();
    });
    // Only with their texts they are as high as their rows.
    for (const stretch of this.stretches) stretch.say();
    this.look();
  }

  /** @param {Drawn} drawn */
  slot(drawn) {
    const slot = this.byId.get(drawn.id) || new Slot(drawn, (one) => this.change(one));
    this.byId.set(drawn.id, slot);
    return slot;
  }

  /** Divide the rows into stretches. */
  divide() {
    const count = Math.ceil(this.slots.length / LENGTH);
    for (const stretch of this.stretches.splice(count)) stretch.remove();
    for (let at = 0; at < count; at++) {
      const stretch = (this.stretches[at] ||= new Stretch());
      stretch.slots = this.slots.slice(at * LENGTH, (at + 1) * LENGTH);
      for (const slot of stretch.slots) slot.stretch = stretch;
    }
  }

  /** Bring the elements into the order of the rows. */
  order() {
    const elements = this.stretches.flatMap((stretch) => stretch.elements);
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
    const [first, end] = this.sight.of(slots, ({ place }) => place);
    const at = document.activeElement;
    /** @param {Slot} slot */
    const isHeld = ({ id, element, isKept }) =>
      isKept || id === this.pressed || element?.contains(at);
    const wanted = new Set(slots.filter((slot, i) => (i >= first && i < end) || isHeld(slot)));
    const leave = slots.filter((slot) => slot.isWhole && !wanted.has(slot));
    const heights = leave.map(({ element }) => element?.offsetHeight || 0);
    leave.forEach((slot, i) => slot.shrink(heights[i]));
    for (const stretch of this.stretches) {
      const near = stretch.slots.find((slot) => wanted.has(slot));
      if (near) near.make();
      else stretch.close();
    }
    this.order();
    for (const slot of wanted) if (!slot.isWhole) slot.draw();
    for (const stretch of this.stretches) stretch.say();
  }

  /** Draw a row whole, before the focus or a hand is in it. @param {string} id */
  touch(id) {
    const slot = this.byId.get(id);
    if (!slot) return null;
    if (!slot.element) {
      slot.make();
      this.order();
      slot.stretch?.say();
    }
    if (!slot.isWhole) slot.draw();
    return slot.element;
  }

  /** @param {string} id */
  place(id) {
    return this.byId.get(id)?.place;
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
      this.touch(slot.id);
      return;
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
    for (const slot of this.slots) {
      slot.height = 0;
      slot.size();
    }
    for (const stretch of this.stretches) stretch.size();
  }

  /** Take all rows out. */
  clear() {
    this.show([]);
    this.sight.end();
    this.stop();
    clearTimeout(this.timer);
  }
}

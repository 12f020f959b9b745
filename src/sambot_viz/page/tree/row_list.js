// @ts-check
/* The rows of a tree in the document. A row that has the focus is never moved there, as it
 * would lose it, and half typed text with it; the others are put round it. */

import { render } from "../vendor/preact.js";

/** @typedef {{id: string, facts: string, view: () => any}} Drawn facts: what the view depends on */

export class RowList {
  /** @param {HTMLElement} host */
  constructor(host) {
    this.host = host;
    /** @type {Map<string, {element: HTMLElement, facts: string}>} */
    this.slots = new Map();
  }

  /**
   * Show rows in an order; those whose facts are as before are left alone.
   * @param {Drawn[]} rows
   */
  show(rows) {
    const wanted = new Set(rows.map(({ id }) => id));
    for (const [id, { element }] of this.slots) {
      if (wanted.has(id)) continue;
      render(null, element);
      element.remove();
      this.slots.delete(id);
    }
    const elements = rows.map(({ id }) => {
      const slot = this.slots.get(id) || { element: document.createElement("div"), facts: "" };
      this.slots.set(id, slot);
      slot.element.className = "slot";
      return slot.element;
    });
    // A row is drawn in its place: what it shows over all else must be in the document.
    this.order(elements);
    for (const { id, facts, view } of rows) {
      const slot = this.slots.get(id);
      if (!slot || slot.facts === facts) continue;
      slot.facts = facts;
      render(view(), slot.element);
    }
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

  /** Take all rows out. */
  clear() {
    this.show([]);
  }
}

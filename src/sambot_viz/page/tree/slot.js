// @ts-check
/* The place of a row in a list. In the document it is drawn whole, or a line of text as high as
 * before, or one of the lines of its stretch. */

import { render } from "../vendor/preact.js";
import { rows } from "../wire/channel.js";
import { refusals } from "../window/notices.js";
import { dress, isPlain } from "./row_element.js";
import { lineText } from "./row_text.js";

/** @typedef {import("./row_element.js").Facts} Facts */
/** @typedef {import("./stretch.js").Stretch} Stretch */
/** @typedef {{id: string, facts: Facts, view: () => any}} Drawn
 *   facts: what the row is drawn from, beside itself; view: what is in its element */

export class Slot {
  /** @param {Drawn} drawn @param {(slot: Slot) => void} changed */
  constructor(drawn, changed) {
    this.id = drawn.id;
    this.drawn = drawn;
    /** What it was drawn from. */
    this.facts = "";
    /** The rows that it stands among. @type {Stretch | null} */
    this.stretch = null;
    /** @type {HTMLElement | null} */
    this.element = null;
    this.isWhole = false;
    /** As it was drawn [px]; 0 before that. */
    this.height = 0;
    this.line = "";
    /** Whether the text that it has while it is not drawn whole may be an old one. */
    this.isStale = true;
    this.stop = rows.listen(this.id, () => changed(this));
  }

  /** Whether it is drawn whole also out of sight. */
  get isKept() {
    const row = rows.get(this.id);
    const { current, chosen, renaming } = this.drawn.facts;
    return current || chosen || renaming || refusals.has(this.id) || Boolean(row && !isPlain(row));
  }

  get isSlider() {
    return rows.get(this.id)?.kind === "slider";
  }

  get depth() {
    return this.drawn.facts.depth;
  }

  /** The row in one line. */
  get text() {
    const row = rows.get(this.id);
    if (this.isStale && row) this.line = lineText(row);
    this.isStale = false;
    return this.line;
  }

  /** Where it is. @returns {{top: number, bottom: number}} */
  get place() {
    const none = { top: 0, bottom: 0 };
    return this.element?.getBoundingClientRect() || this.stretch?.place(this) || none;
  }

  /** Its element, which is new where it had none. */
  make() {
    if (this.element) return this.element;
    this.element = document.createElement("div");
    this.element.className = "line";
    this.element.dataset.row = this.id;
    this.element.setAttribute("role", "row");
    this.size();
    this.dress();
    this.isStale = true;
    return this.element;
  }

  /** While it is not drawn whole it is as high as it was. */
  size() {
    if (!this.element) return;
    this.element.style.minHeight = this.height && !this.isWhole ? `${this.height}px` : "";
  }

  dress() {
    const row = rows.get(this.id);
    if (row && this.element) dress(this.element, row, this.drawn.facts);
  }

  /** Draw it whole, again where its facts are others. */
  draw() {
    const element = this.make();
    if (!this.isWhole) element.replaceChildren();
    this.isWhole = true;
    element.classList.remove("line");
    this.size();
    render(this.drawn.view(), element);
  }

  /** Leave its text. @param {number} height as it was drawn [px] */
  shrink(height) {
    if (this.element) render(null, this.element);
    this.isWhole = false;
    this.height = height;
    this.element?.classList.add("line");
    this.size();
    this.isStale = true;
  }

  /** Show the text of a row that is not drawn whole. */
  say() {
    const element = this.make();
    const cell = element.firstElementChild || document.createElement("span");
    if (!cell.isConnected) element.append(cell);
    cell.setAttribute("role", "gridcell");
    cell.textContent = this.text;
  }

  /** Take its element out. */
  drop() {
    if (this.isWhole && this.element) render(null, this.element);
    this.isWhole = false;
    this.element?.remove();
    this.element = null;
  }

  end() {
    this.stop();
    this.drop();
  }
}

// @ts-check
/* A display that is dragged in its tree: a line shows where it would go; Esc puts it back. */

import { act } from "../wire/channel.js";
import { fold } from "../state.js";
import { reveal } from "../tree/tree.js";
import { members, nearest, places } from "./display_order.js";

/** @typedef {import("../wire/rows.js").Row} Row */

/** So far a hand moves before a click is a drag [px]. */
const SLACK = 5;
/** So near to an edge of the tree it scrolls while something is dragged [px]. */
const EDGE = 24;
/** How much it scrolls in a frame [px]. */
const SCROLL = 6;
/** Where the names begin, and how far each level is indented [px]. */
const MARGIN = 16;
const INDENT = 14;

/**
 * Follow a press that may become a drag.
 * @param {Press} down
 * @param {Row} row
 * @param {HTMLElement} tree
 */
export function dragDisplay(down, row, tree) {
  if (row.display && down.pointerType !== "touch") new Drag(down, row, tree);
}

class Drag {
  /** @param {Press} down @param {Row} row @param {HTMLElement} tree */
  constructor(down, row, tree) {
    this.row = row;
    this.tree = tree;
    this.box = /** @type {HTMLElement} */ (tree.parentElement);
    this.start = this.at = { x: down.clientX, y: down.clientY };
    this.line = document.createElement("div");
    this.line.className = "drop";
    this.frame = 0;
    /** @type {import("./display_order.js").Line | undefined} */
    this.to = undefined;
    this.listeners = new AbortController();
    const { signal } = this.listeners;
    addEventListener("pointermove", (event) => this.move(event), { signal });
    addEventListener("pointerup", () => this.drop(), { signal });
    addEventListener("pointercancel", () => this.end(), { signal });
    addEventListener("keydown", (event) => this.key(event), { signal, capture: true });
  }

  get begun() {
    return this.line.isConnected;
  }

  /** @param {string} id */
  element(id) {
    return this.tree.querySelector(`[data-row="${CSS.escape(id)}"]`);
  }

  /** @param {PointerEvent} event */
  move(event) {
    this.at = { x: event.clientX, y: event.clientY };
    const { start, at } = this;
    if (!this.begun && Math.hypot(at.x - start.x, at.y - start.y) < SLACK) return;
    if (!this.begun) this.begin();
    this.draw();
  }

  begin() {
    this.box.append(this.line);
    this.tree.classList.add("dragging");
    this.element(this.row.id)?.classList.add("dragged");
    getSelection()?.removeAllRanges();
    this.scroll();
  }

  /** Scroll while the hand is near an edge. */
  scroll() {
    const { top, bottom } = this.box.getBoundingClientRect();
    const by = this.at.y < top + EDGE ? -SCROLL : this.at.y > bottom - EDGE ? SCROLL : 0;
    if (by) {
      this.box.scrollTop += by;
      this.draw();
    }
    this.frame = requestAnimationFrame(() => this.scroll());
  }

  /** Show where the display would go. */
  draw() {
    const origin = this.tree.getBoundingClientRect();
    const seen = this.box.getBoundingClientRect();
    const all = places(this.row.id, (id) => this.element(id)?.getBoundingClientRect() ?? null);
    const to = nearest(all, this.at.x - origin.left - MARGIN, this.at.y, INDENT);
    this.to = to;
    this.unmark("into");
    if (to?.into) this.element(to.into)?.classList.add("into");
    this.line.hidden = !to || Boolean(to.into);
    if (!to) return;
    const y = Math.min(Math.max(to.y, seen.top), seen.bottom);
    this.line.style.top = `${y - origin.top - 1}px`;
    this.line.style.left = `${MARGIN + to.depth * INDENT}px`;
  }

  /** @param {string} name of a class */
  unmark(name) {
    for (const marked of this.tree.querySelectorAll(`.${name}`)) marked.classList.remove(name);
  }

  end() {
    this.listeners.abort();
    cancelAnimationFrame(this.frame);
    this.tree.classList.remove("dragging");
    this.unmark("into");
    this.unmark("dragged");
    this.line.remove();
  }

  drop() {
    const { begun, row, to } = this;
    this.end();
    const stays = to && to.group === row.in && to.index === members(row.in).indexOf(row.id);
    if (!begun || !to || stays) return;
    if (to.group) fold(to.group, true);
    reveal("displays", row.id);
    act("displays/move", [row.id, to.group, to.index]);
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    if (event.key !== "Escape") return;
    event.preventDefault();
    event.stopPropagation();
    this.end();
  }
}

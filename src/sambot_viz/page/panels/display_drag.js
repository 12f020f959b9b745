// @ts-check
/* A display that is dragged in its tree, or a topic that is dragged there: a line shows where it
 * would go; Esc ends it. */

import { act } from "../wire/channel.js";
import { fold } from "../state.js";
import { rowElement, rowPlace } from "../tree/row_list.js";
import { reveal } from "../tree/tree.js";
import { members, nearest, places } from "./display_order.js";
import { forTopic, makeDisplay } from "./selected_display.js";

/** @typedef {import("../wire/rows.js").Row} Row */
/** @typedef {import("./display_order.js").Line} Line */

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
  if (!row.display || down.pointerType === "touch") return;
  new Drag(down, tree, {
    source: rowElement(tree, row.id),
    moved: row.id,
    drop: (to) => {
      if (to.group === row.in && to.index === members(row.in).indexOf(row.id)) return;
      if (to.group) fold(to.group, true);
      reveal("displays", row.id);
      act("displays/move", [row.id, to.group, to.index]);
    },
  });
}

/**
 * Follow a press on a topic, which may be dragged into the tree of the displays.
 * @param {Press} down
 * @param {Row} row
 * @param {HTMLElement} from
 */
export function dragTopic(down, row, from) {
  const tree = document.querySelector('[data-panel="displays"]');
  if (row.in || row.kind === "note" || !tree || down.pointerType === "touch") return;
  // Beside its name are texts that can be marked.
  if (!down.target.closest(".name")) return;
  new Drag(down, tree, {
    source: rowElement(from, row.id),
    refused: !row.display,
    drop: (to) => {
      if (to.group && row.display) fold(to.group, true);
      // The server says why a topic cannot be shown.
      makeDisplay("add-topic", forTopic(row.name || "", row.display, "", to), true);
    },
  });
}

class Drag {
  /**
   * @param {Press} down
   * @param {HTMLElement} tree where it can be dropped
   * @param {{source: HTMLElement | null, moved?: string, refused?: boolean,
   *   drop: (to: Line) => void}} what
   *   source: its row; moved: the id of a display of the tree; refused: it has no place there
   */
  constructor(down, tree, what) {
    this.what = what;
    this.tree = tree;
    this.box = /** @type {HTMLElement} */ (tree.parentElement);
    this.start = this.at = { x: down.clientX, y: down.clientY };
    this.line = document.createElement("div");
    this.line.className = "drop";
    this.frame = 0;
    /** @type {Line | undefined} */
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

  /** Where it is dragged to and from. */
  get trees() {
    return [this.tree, this.what.source?.closest(".tree")].filter((tree) => tree != null);
  }

  /** Whether the hand is where it can be dropped: a display stays in its tree. */
  get over() {
    const { left, right, top, bottom } = this.box.getBoundingClientRect();
    const { x, y } = this.at;
    return Boolean(this.what.moved) || (x >= left && x <= right && y >= top && y <= bottom);
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
    for (const tree of this.trees) tree.classList.add("dragging");
    this.what.source?.classList.add("dragged");
    getSelection()?.removeAllRanges();
    this.scroll();
  }

  /** Scroll while the hand is near an edge. */
  scroll() {
    const { top, bottom } = this.box.getBoundingClientRect();
    const by = this.at.y < top + EDGE ? -SCROLL : this.at.y > bottom - EDGE ? SCROLL : 0;
    if (by && this.over) {
      this.box.scrollTop += by;
      this.draw();
    }
    this.frame = requestAnimationFrame(() => this.scroll());
  }

  /** Show where it would go. */
  draw() {
    const { moved = "", refused } = this.what;
    const origin = this.tree.getBoundingClientRect();
    const seen = this.box.getBoundingClientRect();
    const all = places(moved, (id) => rowPlace(this.tree, id));
    const x = this.at.x - origin.left - MARGIN;
    const to = this.over ? nearest(all, x, this.at.y, INDENT) : undefined;
    this.to = to;
    this.unmark();
    this.line.hidden = !to || Boolean(to.into || refused);
    if (refused && to) this.tree.classList.add("refuses");
    if (refused || !to) return;
    if (to.into) rowElement(this.tree, to.into)?.classList.add("into");
    const y = Math.min(Math.max(to.y, seen.top), seen.bottom);
    this.line.style.top = `${y - origin.top - 1}px`;
    this.line.style.left = `${MARGIN + to.depth * INDENT}px`;
  }

  unmark() {
    this.tree.classList.remove("refuses");
    for (const marked of this.tree.querySelectorAll(".into")) marked.classList.remove("into");
  }

  end() {
    this.listeners.abort();
    cancelAnimationFrame(this.frame);
    for (const tree of this.trees) tree.classList.remove("dragging");
    this.unmark();
    this.what.source?.classList.remove("dragged");
    this.line.remove();
  }

  drop() {
    const { begun, to } = this;
    this.end();
    if (begun && to) this.what.drop(to);
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    if (event.key !== "Escape") return;
    event.preventDefault();
    event.stopPropagation();
    this.end();
  }
}

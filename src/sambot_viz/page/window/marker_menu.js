// @ts-check
/* The menu of an interactive marker, where the pointer is; the server says when it opens. */

import { html, useEffect, useState } from "../vendor/preact.js";
import { act, rows } from "../wire/channel.js";
import { Menu } from "./menu.js";

/** @typedef {{id: number, title: string, runs: boolean, entries: Entry[]}} Entry */
/** A menu; of one below an entry, the one with the entry. first: what has the focus first.
 * @typedef {{number: any, title: string, entries: Entry[], above?: Shown, first?: string}} Shown */

const BACK = "‹ Back";

/** Where a button was pressed or released last. */
let at = { x: 0, y: 0 };

/** Over a handle the mouse is a hand. */
function showHand() {
  const over = rows.data("tools/over");
  document.body.classList.toggle("over-handle", Boolean(over?.holds));
}

export function MarkerMenu() {
  const [opened, setOpened] = useState(/** @type {Shown | null} */ (null));
  useEffect(() => {
    let seen = rows.data("tools/menu")?.number ?? 0;
    const told = () => {
      const menu = rows.data("tools/menu");
      if (menu && menu.number > seen) setOpened(menu);
      seen = menu?.number ?? seen;
    };
    /** @param {PointerEvent} event */
    const press = ({ clientX: x, clientY: y }) => (at = { x, y });
    const kinds = /** @type {const} */ (["pointerdown", "pointerup"]);
    for (const kind of kinds) addEventListener(kind, press, true);
    const stops = [rows.listen("tools/menu", told), rows.listen("tools/over", showHand)];
    return () => {
      for (const kind of kinds) removeEventListener(kind, press, true);
      for (const stop of stops) stop();
    };
  }, []);
  if (!opened) return null;
  const { number, title, entries, above, first } = opened;
  const back = above && (() => setOpened({ ...above, first: opens(title) }));
  /** @param {Entry} entry */
  const below = (entry) => {
    const first = labelOf(entry.entries[0]);
    setOpened({ ...entry, number: `${number} ${entry.id}`, above: opened, first });
  };
  const items = entries.map((entry) => item(entry, below));
  return html`<${Menu} key=${`${number} ${first}`} label=${title} at=${at} first=${first} back=${back}
    items=${back ? [{ label: BACK, act: back }, null, ...items] : items}
    close=${() => setOpened(null)} />`;
}

/** @param {string} title of an entry with a menu */
const opens = (title) => `${title} ▸`;

/** @param {Entry} entry */
function labelOf({ title, runs, entries }) {
  if (entries.length) return opens(title);
  return runs ? `${title} (runs a command on RViz's machine: not done here)` : title;
}

/** @param {Entry} entry @param {(entry: Entry) => void} open shows the menu below an entry */
function item(entry, open) {
  const { id, runs, entries } = entry;
  const label = labelOf(entry);
  if (entries.length) return { label, below: true, act: () => open(entry) };
  return { label, off: runs || !id, act: () => act("tools/entry", [id]) };
}

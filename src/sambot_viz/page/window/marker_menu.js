// @ts-check
/* The menu of an interactive marker, where the pointer is; the server says when it opens. */

import { html, useEffect, useState } from "../vendor/preact.js";
import { act, rows } from "../wire/channel.js";
import { Menu } from "./menu.js";

/** @typedef {{id: number, title: string, runs: boolean, entries: Entry[]}} Entry */

/** Where a button was pressed or released last. */
let at = { x: 0, y: 0 };

/** Over a handle the mouse is a hand. */
function showHand() {
  const over = rows.data("tools/over");
  document.body.classList.toggle("over-handle", Boolean(over?.holds));
}

export function MarkerMenu() {
  const [opened, setOpened] = useState(
    /** @type {{number: any, title: string, entries: Entry[]} | null} */ (null),
  );
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
  return html`<${Menu} key=${`${opened.number} ${opened.title}`} label=${opened.title} at=${at}
    items=${opened.entries.map((entry) => item(entry, (below) => setOpened(below)))}
    close=${() => setOpened(null)} />`;
}

/** @param {Entry} entry @param {(menu: any) => void} open shows the menu below an entry */
function item({ id, title, runs, entries }, open) {
  if (entries.length)
    return { label: `${title} ▸`, act: () => open({ number: `below ${id}`, title, entries }) };
  const label = runs ? `${title} (runs a command on RViz's machine: not done here)` : title;
  return { label, off: runs || !id, act: () => act("tools/entry", [id]) };
}

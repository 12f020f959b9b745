// @ts-check
/* The line on top: menus, tools, name of the file. Where there is little room, words go first. */

import { html, useLayoutEffect, useRef, useState } from "../vendor/preact.js";
import { room } from "./splitters.js";
import { FileName } from "./files.js";
import { MenuBar } from "./menus.js";
import { goTo } from "./palette.js";
import { useData } from "../state.js";
import { Toolbar } from "./toolbar.js";

/** What is left out, from wide windows to narrow ones. */
const STEPS = [
  "",
  "few-words",
  "few-words one-menu",
  "no-words one-menu",
  "no-words one-menu compact",
  "no-words one-menu compact no-name",
];

/** @param {{panels: () => import("./menus.js").PanelOf[], hideAll: () => void}} props */
export function Top({ panels, hideAll }) {
  const { width } = room.use();
  useData("tools/list");
  /** @type {Ref} */
  const element = useRef(null);
  // Each step is tried, as only the browser knows how wide words are; nothing is painted before.
  const [tried, setTried] = useState({ width, step: 0 });
  const step = tried.width === width ? tried.step : 0;
  useLayoutEffect(() => {
    const { scrollWidth, clientWidth } = element.current;
    if (scrollWidth > clientWidth && step < STEPS.length - 1) setTried({ width, step: step + 1 });
  });
  return html`<header class=${`top ${STEPS[step]}`} ref=${element}>
    <h1 class="spoken">sambot-viz</h1>
    <${MenuBar} panels=${panels} hideAll=${hideAll} goTo=${goTo} small=${step >= 2} /><${Toolbar} />
    <${FileName} />
  </header>`;
}

// @ts-check
/* Small pictures, drawn here: outlines on a grid of 16 by 16. */

import { html } from "../vendor/preact.js";
import { DISPLAY_ICONS } from "./display_icons.js";

/** @type {Record<string, string>} */
const PATHS = {
  ...DISPLAY_ICONS,
  marker: DISPLAY_ICONS.Marker,
  pose: DISPLAY_ICONS.Pose,
  ok: "M3 8.5l3.5 3.5L13 4.5",
  warn: "M8 2l6.5 12h-13zM8 6v4M8 12v.5",
  error: "M8 1.5a6.5 6.5 0 1 0 .01 0M5.5 5.5l5 5M10.5 5.5l-5 5",
  info: "M8 1.5a6.5 6.5 0 1 0 .01 0M8 7v4.5M8 4.5v.5",
  help: "M8 1.5a6.5 6.5 0 1 0 .01 0M6 6.5a2 2 0 1 1 2.8 1.8c-.6.3-.8.6-.8 1.2M8 11.3v.5",
  options:
    "M8 5.5a2.5 2.5 0 1 0 .01 0M8 1.5v2M8 12.5v2M1.5 8h2M12.5 8h2M3.4 3.4l1.4 1.4M11.2 11.2l1.4 1.4M12.6 3.4l-1.4 1.4M4.8 11.2l-1.4 1.4",
  link: "M4 4h8v8H4z",
  joint: "M8 5.5a2.5 2.5 0 1 0 .01 0M1.5 8h4M10.5 8h4",
  frame: "M4 12V3M4 12h9M4 12l4-4",
  points: "M4 10a1.5 1.5 0 1 0 .01 0M8 3a1.5 1.5 0 1 0 .01 0M12 9a1.5 1.5 0 1 0 .01 0",
  Interact:
    "M6 8V3.2a1.2 1.2 0 0 1 2.4 0V7l4 .8c.8.2 1 .8.9 1.5l-.7 4.2H7L4 9.8c-.6-1 .6-1.8 1.3-1.1z",
  "Move Camera":
    "M8 1.5v13M1.5 8h13M8 1.5L6 3.5M8 1.5l2 2M8 14.5l-2-2M8 14.5l2-2M1.5 8l2-2M1.5 8l2 2M14.5 8l-2-2M14.5 8l-2 2",
  Select: "M2.5 2.5h11v11h-11z",
  "Focus Camera": "M8 4.5a3.5 3.5 0 1 0 .01 0M8 1.5v5M8 9.5v5M1.5 8h5M9.5 8h5",
  "2D Pose Estimate": "M2 8h9M8 4.5 11.5 8 8 11.5M14 3.5v9",
  "2D Goal Pose": "M4.5 14V2h8l-2 3 2 3h-8",
  "Nav2 Goal": "M4.5 14V2h8l-2 3 2 3h-8",
  "Publish Point": "M8 14s4.5-4.4 4.5-7.6a4.5 4.5 0 0 0-9 0C3.5 9.6 8 14 8 14zM8 5v3",
  Measure: "M1.5 5.5h13v5h-13zM4.5 5.5v2M7.5 5.5v3M10.5 5.5v2",
  undo: "M6 3L2.5 6.5 6 10M3 6.5h6a4 4 0 0 1 0 8H7",
  redo: "M10 3l3.5 3.5L10 10M13 6.5H7a4 4 0 0 0 0 8h2",
  focus: "M1.5 5V1.5H5M11 1.5h3.5V5M14.5 11v3.5H11M5 14.5H1.5V11M5 5.5h6v5H5z",
  zero: "M2 8l6-5.5L14 8M4 7v6.5h8V7",
  full: "M2 6V2h4M10 2h4v4M14 10v4h-4M6 14H2v-4",
  hide: "M2 3h12v10H2zM5 3v10M11 3v10",
  view: "M1.5 8c3-5 10-5 13 0c-3 5-10 5-13 0M8 6a2 2 0 1 0 .01 0",
  turn: "M13 4.5A6 6 0 1 0 14 9M13.5 1.5v3.5H10",
  play: "M4.5 3l8 5-8 5z",
  pause: "M4 3h3v10H4zM9 3h3v10H9z",
  toBegin: "M2 3v10M8 3l-5 5 5 5zM14 3l-5 5 5 5z",
  stepBack: "M3.5 3v10M12.5 3l-7 5 7 5z",
  stepOn: "M12.5 3v10M3.5 3l7 5-7 5z",
  loop: "M12 2l2.5 2.5L12 7M14.5 4.5H4a2.5 2.5 0 0 0-2.5 2.5M4 14l-2.5-2.5L4 9M1.5 11.5H12a2.5 2.5 0 0 0 2.5-2.5",
  stop: "M4 4h8v8H4z",
  close: "M4 4l8 8M12 4l-8 8",
  trash: "M2.5 4.5h11M6 4.5V2.5h4v2M4 4.5l.8 9.5h6.4l.8-9.5M6.7 7v4.5M9.3 7v4.5",
  add: "M8 3v10M3 8h10",
  remove: "M3 8h10",
  rename: "M3 13l1-3.5 6.5-6.5 2.5 2.5-6.5 6.5z",
  copy: "M5.5 5.5h8v8h-8zM3 10.5h-.5v-8h8V3",
  search: "M7 2.5a4.5 4.5 0 1 0 .01 0M10.3 10.3l3.7 3.7",
  forwards: "M8 3l5 9H3z",
  back: "M8 13L3 4h10z",
  left: "M3 8l9-5v10z",
  right: "M13 8l-9 5V3z",
  down: "M4 6l4 4 4-4",
  foldAll: "M4 2l4 4 4-4M4 14l4-4 4 4",
  unfoldAll: "M4 6l4-4 4 4M4 10l4 4 4-4",
  fold: "M10 3L5 8l5 5",
  unfold: "M6 3l5 5-5 5",
  open: "M2 13V3.5h4l1.5 2H13V7M2 13l2.5-6H15l-2.5 6z",
  people:
    "M6 2.5a2.5 2.5 0 1 0 .01 0M1.5 13.5c0-6.5 9-6.5 9 0M11 3a2.2 2.2 0 0 1 0 4.4M12 9c1.8.6 2.5 2.2 2.5 4.5",
  menu: "M2 4h12M2 8h12M2 12h12",
};
const FILLED = new Set(["play", "pause", "stop", "forwards", "back", "left", "right"]);
const DASHED = new Set(["Select"]);

/** @param {{name?: string}} props */
export function Icon({ name = "" }) {
  const path = PATHS[name] || (name ? "M4 4h8v8H4z" : "");
  return html`<svg class=${`icon i-${name in PATHS ? name.replace(/ /g, "") : "other"}`}
    viewBox="0 0 16 16" aria-hidden="true">
    <path d=${path} fill=${FILLED.has(name) ? "currentColor" : "none"} stroke="currentColor"
      stroke-width="1.4"
      stroke-dasharray=${DASHED.has(name) ? "2 1.5" : undefined} stroke-linejoin="round"
        stroke-linecap="round" />
  </svg>`;
}

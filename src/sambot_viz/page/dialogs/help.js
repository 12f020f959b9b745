// @ts-check
/* Help: the keys, and what this program is. */

import { html } from "../vendor/preact.js";
import { rows } from "../wire/channel.js";
import { toolKeys } from "../window/toolbar.js";
import { Dialog } from "./dialog.js";

/** @type {[string, [string, string][]][]} */
const KEYS = [
  [
    "The view",
    [
      ["Left button", "turn"],
      ["Middle button, or Shift and left", "move"],
      ["Right button, or wheel", "zoom"],
      ["F", "look at what is under the mouse, or at the robot; with Select, at the selection"],
      ["Z", "reset the view to its default"],
      ["1 3 7", "front, right side, top without perspective; 1 or 3 again: back, left side"],
      ["R", "reload meshes and redraw"],
      ["O", "show everyone what you have selected"],
      ["P G U", "with a live robot: 2D Pose Estimate, 2D Goal Pose, Publish Point"],
      ["H", "hide or show all panels"],
      ["Esc", "back to the first tool; twice: STOP, for a live robot"],
      ["8 2 4 6 in Drive", "add speed"],
      ["5", "stop driving"],
    ],
  ],
  [
    "Recordings",
    [
      ["Space", "play, pause"],
      [", .", "message before, next message"],
      ["← →", "one second back, on"],
      ["Home End", "to the beginning, to the end"],
    ],
  ],
  [
    "Rows",
    [
      ["↑ ↓ Home End", "select another row"],
      ["→ ←", "expand, collapse"],
      ["Space", "toggle"],
      ["Enter", "edit the value; accept it"],
      ["Esc", "cancel the edit"],
      ["↑ ↓ in a number", "one step; with Shift ten, with Alt a tenth"],
      ["F2, Delete", "rename, remove a display or a saved view"],
      ["Alt+↑, Alt+↓", "move a display"],
      ["Ctrl+C", "copy the row"],
      ["Shift+F10", "context menu"],
    ],
  ],
  [
    "Numbers",
    [
      ["1.5, 1e-3, (1+2)/4", "a number or a sum"],
      ["90deg, 15 mm", "in this unit, whichever unit is shown"],
      ["pi/2, tau", "in radians, even where degrees are shown"],
    ],
  ],
  [
    "Everywhere",
    [
      ["Ctrl+Z, Ctrl+Shift+Z", "undo, redo"],
      ["Ctrl+K", "go to a display, joint, frame or command"],
      ["Ctrl+S, Ctrl+Shift+S", "save the config (or the text of the model), save it under a name"],
      ["Tab", "next field, button or panel"],
    ],
  ],
];

/** @param {{close: () => void}} props */
export function Keys({ close }) {
  const tools = toolKeys()
    .filter(({ key }) => key)
    .map(({ name, key }) => /** @type {[string, string]} */ ([key.toUpperCase(), name]));
  return html`<${Dialog} title="Keys" close=${close} submit=${close} wide>
    <div class="key-list">${[
      ...KEYS.slice(0, 1),
      /** @type {[string, [string, string][]]} */ (["Tools", tools]),
      ...KEYS.slice(1),
    ].map(
      ([title, list]) => html`
      <section key=${title}><h3>${title}</h3><table aria-label=${title}>
        ${list.map(
          ([keys, does]) => html`<tr key=${keys}><th scope="row"><kbd>${keys}</kbd></th>
          <td>${does}</td></tr>`,
        )}
      </table></section>`,
    )}</div>
    <p class="soft">Letter keys work while you are not typing.</p>
    <div class="buttons end"><button type="submit" class="main" data-first>Close</button></div>
  </${Dialog}>`;
}

/** @param {{close: () => void}} props */
export function About({ close }) {
  return html`<${Dialog} title="About sambot-viz" close=${close} submit=${close}>
    <p>${`sambot-viz ${rows.data("names/version")}, under the Apache License 2.0.`}</p>
    <p>Shows URDF, SDF and xacro robots in the browser, as RViz does, without ROS.</p>
    <p>The page draws with viser (Apache-2.0) and three.js (MIT), and its panels with${" "}
      Preact (MIT) and htm (Apache-2.0).${" "}
      <a href="./sambot/licenses.txt" target="_blank"
        rel="noopener">The licences of Preact and htm</a></p>
    <p class="soft">docs/displays.md lists the supported displays,${" "}
      docs/command-line.md the options.</p>
    <div class="buttons end"><button type="submit" class="main" data-first>Close</button></div>
  </${Dialog}>`;
}

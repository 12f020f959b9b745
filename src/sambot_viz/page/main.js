// @ts-check
/* The page: the view as RViz draws it, and the window round it. */

import "./bare.js";
import { html, render } from "./vendor/preact.js";
import { act, connect, HOVER, newGesture, rows, send } from "./channel.js";
import { followConnection } from "./connection.js";
import { togglePanels } from "./edges.js";
import { followFile } from "./files.js";
import { listenToKeys } from "./keys.js";
import { followLinks } from "./link.js";
import { tellView } from "./panels/views.js";
import { cancelPress, followMouse, mousePlace } from "./pointer.js";
import { followRole } from "./people.js";
import { followScript } from "./script_panel.js";
import { toolKeys } from "./toolbar.js";
import { Window } from "./window.js";

const start = () => {
  const host = document.createElement("div");
  host.id = "sambot";
  document.body.append(host);
  document.body.classList.add("sambot-window");
  render(html`<${Window} />`, host);
  listenToKeys({ tools: toolKeys, mouse: mousePlace, act, hide: togglePanels, cancelPress });
  const hovering = newGesture();
  followMouse({
    wantsHover: () => rows.children("panel:tools").some((id) => rows.get(id)?.hover),
    // Of the places that wait, only the last one counts.
    hover: (place) => send(HOVER, place, hovering),
    rightClick: () => act("tools/right_click"),
  });
  tellView();
  followFile();
  followConnection();
  followRole();
  followLinks();
  followScript();
  connect();
};
// The script may be there before the page's body is.
if (document.readyState !== "loading") start(); else addEventListener("DOMContentLoaded", start);

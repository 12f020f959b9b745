// @ts-check
/* The page's window round viser's 3D view. It is there as soon as rows are. */

import "./rviz_look.js";
import "./rviz_mouse.js";
import { html, render } from "./vendor/preact.js";
import { connect, rows } from "./channel.js";
import { listenToKeys } from "./keys.js";
import { Window } from "./window.js";

const host = document.createElement("div");
host.id = "sambot";
document.body.append(host);

let shown = false;
const show = () => {
  if (shown) return;
  shown = true;
  document.body.classList.add("sambot-window");
  render(html`<${Window} />`, host);
  listenToKeys();
};
// A page without panels, such as that of a snapshot, stays the bare view.
rows.listen("panel:displays", show);
connect();

// @ts-check
/* The page: the view as RViz draws it, and the window round it. */

import "./bare.js";
import { html, render } from "./vendor/preact.js";
import { connect } from "./channel.js";
import { listenToKeys } from "./keys.js";
import { Window } from "./window.js";

const start = () => {
  const host = document.createElement("div");
  host.id = "sambot";
  document.body.append(host);
  document.body.classList.add("sambot-window");
  render(html`<${Window} />`, host);
  listenToKeys();
  connect();
};
// The script may be there before the page's body is.
if (document.readyState !== "loading") start(); else addEventListener("DOMContentLoaded", start);

// @ts-check
/* What the page says when it has lost its connection to the server, and when it is back.
 * viser reconnects by itself, once a second. */

import { html } from "./vendor/preact.js";
import { goOnline, isConnected, rows } from "./channel.js";
import { Cell } from "./state.js";

/** How often the page looks [ms]. */
const PERIOD = 250;
/** How long the page says that the connection is back [ms]. */
const BACK = 8000;

/** What is said over the view. @type {Cell<{text: string, level: string, close?: boolean} | null>} */
const said = new Cell(/** @type {{text: string, level: string, close?: boolean} | null} */ (null));

/** Follow the connection from now on. */
export function followConnection() {
  let was = false, lost = false;
  /** The session that the rows are of. @type {any} */
  let session;
  setInterval(() => {
    const now = isConnected();
    if (was && !now) {
      lost = true;
      goOnline(false);
      said.set({ text: "Connection lost. Trying again…", level: "error" });
    }
    was = now;
  }, PERIOD);
  // The rows of this browser come after those of everyone.
  rows.listen("whole:browser", () => {
    const now = rows.value("names/session"), before = session;
    session = now;
    if (!lost) return;
    lost = false;
    goOnline(true);
    if (before?.id === now?.id) {
      const back = { text: "The connection is back.", level: "ok" };
      said.set(back);
      setTimeout(() => { if (said.value === back) said.set(null); }, BACK);
    } else said.set({ text: `The connection is back. ${now?.lost || ""}`, level: "warn", close: true });
  });
}

/** The sentence over the view. */
export function Connection() {
  const now = said.use();
  return html`<div class="connection" role="status" aria-live="assertive">${now && html`<p class=${`l-${now.level}`}>${now.text}
    ${now.close && html`<button onClick=${() => said.set(null)}>OK</button>`}</p>`}</div>`;
}

// @ts-check
/* What the page says when it has lost its connection to the server, and when it is back.
 * viser reconnects by itself, once a second. A browser slows that down after some failures,
 * until viser never gets through: then the page is loaded again, with view and folds.
 * So it is when a user comes back to a page that the browser has kept while another address
 * was shown: it would stay connected, and count as one that is looked at. */

import { html } from "./vendor/preact.js";
import { CUT, disconnect, goOnline, isConnected, rows, send } from "./channel.js";
import { Cell, folds } from "./state.js";

/** How often the page looks [ms]. */
const PERIOD = 250;
/** How long the server answers without viser getting through, before a new start [ms]. */
const STUCK = 6000;
/** Where the page keeps what it must not forget when it is loaded again. */
const KEPT = "sambot-viz-again";
/** How long the page says that the connection is back [ms]. */
const BACK = 8000;

/** What is said over the view. @type {Cell<{text: string, level: string, close?: boolean} | null>} */
const said = new Cell(/** @type {{text: string, level: string, close?: boolean} | null} */ (null));

/** Follow the connection from now on. */
export function followConnection() {
  let was = false, lost = false;
  /** The session that the rows are of. @type {any} */
  let session;
  let kept = takeKept();
  const cut = () => {
    if (lost) return;
    lost = true;
    goOnline(false);
    said.set({ text: "Connection lost. Trying again…", level: "error" });
    startAgainWhenStuck(() => lost, () => session);
  };
  rows.listen(CUT, cut);
  setInterval(() => {
    const now = isConnected();
    if (was && !now) cut();
    was = now;
  }, PERIOD);
  // The rows of this browser come after those of everyone.
  rows.listen("whole:browser", () => {
    const now = rows.value("names/session"), before = session;
    session = now;
    if (!lost && !kept) return;
    lost = false;
    goOnline(true);
    const known = kept ? kept.session : before?.id, silent = kept?.left;
    if (kept) bringBack(kept.view);
    kept = null;
    if (known === now?.id && silent) return;
    if (known === now?.id) {
      const back = { text: "The connection is back.", level: "ok" };
      said.set(back);
      setTimeout(() => { if (said.value === back) said.set(null); }, BACK);
    } else said.set({ text: `The connection is back. ${now?.lost || ""}`, level: "warn", close: true });
  });
  addEventListener("pagehide", (event) => { if (event.persisted) disconnect(); });
  addEventListener("pageshow", (event) => { if (event.persisted) startAgain(session, true); });
}

/** Load the page again, with what it shows. @param {any} session @param {boolean} left whether a user had left the page */
function startAgain(session, left) {
  sessionStorage.setItem(KEPT, JSON.stringify({ session: session?.id, view: viewValues(), folds: folds.value, left }));
  location.reload();
}

/** The rows of this page's view that can be set, and their values. @returns {[string, any][]} */
function viewValues() {
  return (rows.panels.get("views") || []).map((id) => rows.get(id)).filter((row) => row?.id.startsWith("view/") && !row.fixed)
    .map((row) => /** @type {[string, any]} */ ([row?.id, row?.value]));
}

/** @param {() => boolean} lost @param {() => any} session */
function startAgainWhenStuck(lost, session) {
  let answered = 0;
  const look = setInterval(async () => {
    if (!lost()) return clearInterval(look);
    const there = await fetch("./", { cache: "no-cache" }).then((answer) => answer.ok, () => false);
    if (!there) answered = 0;
    else if (!answered) answered = Date.now();
    else if (lost() && Date.now() - answered > STUCK) startAgain(session(), false);
  }, STUCK / 3);
}

/** What the page has kept, once. @returns {{session: any, view: [string, any][], folds: any, left: boolean} | null} */
function takeKept() {
  try {
    const kept = JSON.parse(sessionStorage.getItem(KEPT) || "null");
    sessionStorage.removeItem(KEPT);
    if (kept) folds.set(kept.folds);
    return kept;
  } catch { return null; }
}

/** Set the view as it was; another type first gets its rows. @param {[string, any][]} values */
function bringBack(values) {
  const set = () => {
    for (const [id, value] of values) {
      if (id !== "view/type" && JSON.stringify(rows.value(id)) !== JSON.stringify(value)) send(id, value);
    }
  };
  const type = values.find(([id]) => id === "view/type")?.[1];
  if (type === undefined || type === rows.value("view/type")) return set();
  send("view/type", type);
  setTimeout(set, 1000);
}

/** The sentence over the view. */
export function Connection() {
  const now = said.use();
  return html`<div class="connection" role="status" aria-live="assertive">${now && html`<p class=${`l-${now.level}`}>${now.text}
    ${now.close && html`<button onClick=${() => said.set(null)}>OK</button>`}</p>`}</div>`;
}

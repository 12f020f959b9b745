// @ts-check
/* What the page says when it has lost its connection to the server, and when it is back.
 * Both connections are tried again as retries.js says. When the server answers and they do not
 * get through all the same, the page is loaded again, with view and folds.
 * So it is when a user comes back to a page that the browser has kept while another address
 * was shown: it would stay connected, and count as one that is looked at. */

import { html } from "../vendor/preact.js";
import {
  act,
  CUT,
  disconnect,
  FOLLOWS,
  goOffline,
  goOnline,
  heldBack,
  holdBack,
  REMOVED,
  rows,
  sendHeldBack,
  STOPS,
  WAITING,
} from "./channel.js";
import {
  foldsNow,
  hasJoints,
  idsNow,
  jointsToBringBack,
  listed,
  lost as lostOf,
  otherConfig,
  remember,
  showView,
  withoutRobot,
} from "./reconnect.js";
import { retries } from "./retries.js";
import { hasDisk } from "../window/files.js";
import { Cell, folds, selected, useData, useRow } from "../state.js";
import { selectAgain } from "../tree/select_again.js";

/** @typedef {import("./reconnect.js").Memory} Memory */
/** @typedef {Memory & {waiting: any[][], stuck: boolean, at: string}} Kept what a page that is loaded again has kept */

/** How long the server answers without viser getting through, before a new start [ms]. */
const STUCK = 6000;
/** Where the page keeps what it must not forget when it is loaded again. */
const KEPT = "sambot-viz-again";
/** Pages of followers come again within so long, each at another moment [ms]. */
const SPREAD = 900;
/** How long the page says that the connection is back [ms]. */
const BACK = 8000;

/** What is said over the view: that there is no connection, or what came back.
 * @type {Cell<"removed" | import("./retries.js").State | {text: string, lost: string[], other: Memory["file"] | null, before: Memory} | null>} */
const said = new Cell(/** @type {any} */ (null));

/** Whether the server has said that it stops. */
let stopped = false;

/** Follow the connection from now on. */
export function followConnection() {
  let lost = false,
    stuck = false;
  let kept = takeKept();
  /** How things were before the connection was lost. @type {Memory | null} */
  let before = kept;
  /** What waits for the robot, which may come later than the page. */
  let whenJoints = () => {};
  said.listeners.add(() => {
    const away = isState(said.value) || said.value === "removed";
    document.body.classList.toggle("offline", away);
  });
  const cut = () => {
    if (lost) return;
    lost = true;
    before = remember();
    goOffline();
    said.set({ tries: 0, waited: 0, status: 0, ended: false });
  };
  rows.listen(CUT, cut);
  rows.listen(FOLLOWS, () => (retries.spread = SPREAD));
  rows.listen(REMOVED, () => {
    lost = true;
    goOffline();
    said.set("removed");
  });
  rows.listen(STOPS, () => (stopped = true));
  let answered = 0;
  retries.listeners.push((state) => {
    // A page that has just been opened may wait for its turn.
    if (lost || state.tries > 2) said.set({ ...state });
    if (state.status !== 200 || window.sambotViser?.state === "open") answered = 0;
    else answered ||= Date.now();
    if (lost && answered && Date.now() - answered > STUCK) {
      stuck = true;
      location.reload();
    }
  });
  /** The rows that are selected when the rows of a new server come. */
  let chosen = selected.value;
  rows.listen("whole:session", () => (chosen = selected.value));
  // The rows of this browser come after those of everyone.
  rows.listen("whole:browser", () => {
    if (isState(said.value)) said.set(null);
    if (!before || !(lost || kept)) return;
    const then = before,
      silent = kept && !kept.stuck,
      here = kept?.at === location.pathname,
      again = rows.data("names/session");
    const loaded = Boolean(kept);
    lost = stopped = false;
    kept = null;
    goOnline();
    // Nothing that a server keeps for a page of a follower is this page's own.
    if (rows.data(FOLLOWS)) return loaded ? said.set(null) : sayBack("", then);
    showView(then, loaded);
    // The robot is elsewhere than it was when this view showed it.
    if (then.robot?.drives || (then.robot?.away && then.session !== again?.id)) act("drive/find");
    if (then.session === again?.id) {
      if (then.edits) act("edit/resume", [then.edits]);
      sendHeldBack();
      if (!silent) say("", then, 0);
      return;
    }
    folds.set(foldsNow(then, folds.value));
    const there = idsNow(then);
    if (!loaded) selectAgain(chosen, there);
    const flush = () =>
      sendHeldBack((id) => {
        const now = there(id);
        if (now && rows.get(now)) return now;
        return now?.startsWith("j/") && !hasJoints() ? undefined : null;
      });
    whenJoints = () => {
      if (!hasJoints()) return;
      whenJoints = () => {};
      const [moved, positions] = jointsToBringBack(then);
      if (moved.length && rows.data("joints/untouched")) act("joints/restore", [moved, positions]);
      flush();
    };
    whenJoints();
    const copied = Boolean(silent && here && rows.data("people/state")?.copy);
    say(copied ? NEW_COPY : again?.again || "", then, flush(), Boolean(silent), copied);
  });
  rows.listen("joints/untouched", () => whenJoints());
  addEventListener("pagehide", (event) => {
    const now = lost && before ? before : remember();
    if (kept || now.session)
      keep(
        kept || { ...now, folds: folds.value, waiting: heldBack(), stuck, at: location.pathname },
      );
    if (event.persisted) disconnect();
  });
  addEventListener("pageshow", (event) => {
    if (event.persisted) location.reload();
  });
}

/** What a user reads who has loaded the page of a private copy again. */
const NEW_COPY =
  "This is a new private copy of the shared robot as it is now; the one before has ended.";

/** Say that the connection is back, and what is not as before.
 * @param {string} again why @param {Memory} before @param {number} dropped edits @param {boolean} [quiet] when all is as before @param {boolean} [news] why is said also then */
function say(again, before, dropped, quiet = false, news = false) {
  const lost = lostOf(before),
    other = otherConfig(before);
  if (dropped)
    lost.push(
      dropped > 1
        ? `${dropped} changes that you made meanwhile`
        : "a change that you made meanwhile",
    );
  if (quiet && !news && !lost.length && !other) return said.set(null);
  // A user who has loaded the page again has lost no connection.
  sayBack(again, before, quiet, lost, other);
}

/** Say that the connection is back; for some seconds, when nothing is lost.
 * @param {string} again why @param {Memory} before @param {boolean} [quiet] when a user has loaded the page again
 * @param {string[]} [lost] @param {Memory["file"] | null} [other] the config that was open before */
function sayBack(again, before, quiet = false, lost = [], other = null) {
  const text = quiet ? again : `The connection is back. ${again}`.trim();
  const back = { text, lost, other, before };
  said.set(back);
  if (!lost.length && !other)
    setTimeout(() => {
      if (said.value === back) said.set(null);
    }, BACK);
}

/** Keep what a page that is loaded again has to know. @param {Kept} kept */
function keep(kept) {
  try {
    sessionStorage.setItem(KEPT, JSON.stringify(kept));
  } catch {
    /* private windows have none */
  }
}

/** What the page has kept, once. @returns {Kept | null} */
function takeKept() {
  try {
    const kept = JSON.parse(sessionStorage.getItem(KEPT) || "null");
    sessionStorage.removeItem(KEPT);
    // A copy of one's own is another robot: only the view and the folds go there and back.
    if (kept && kept.at !== location.pathname)
      Object.assign(kept, withoutRobot(kept), { waiting: [], stuck: false });
    if (kept) {
      folds.set(kept.folds);
      holdBack(kept.waiting);
    }
    return kept;
  } catch {
    return null;
  }
}

/** Open the config that was open before, with the rows that were unfolded. @param {Memory} before */
function openAgain(before) {
  // Its name and its rows may come in two messages, in either order.
  let named = false;
  let listed = false;
  const unfold = () => folds.set(foldsNow(before, before.folds));
  const stopRows = rows.listen("panel:displays", () => {
    listed = true;
    unfold();
    if (named) stopRows();
  });
  const stop = rows.listen("names/document", () => {
    stop();
    named = true;
    unfold();
    if (listed) stopRows();
    showView(before);
    said.set(null);
  });
  act("file/open", [before.file.name]);
}

/** The sentence over the view. */
export function Connection() {
  const now = said.use(),
    trouble = useData(FOLLOWS)?.trouble;
  return html`<div class="connection" role="status" aria-live="assertive">
    ${
      now === "removed"
        ? html`<${Removed} />`
        : isState(now)
          ? html`<${Lost} ...${now} />`
          : trouble
            ? html`<p class="l-error">${`${trouble}. Trying again…`}</p>`
            : now && html`<${Back} ...${now} />`
    }</div>`;
}

/** @param {any} now @returns {now is import("./retries.js").State} */
const isState = (now) => Boolean(now && typeof now === "object" && "tries" in now);

function Removed() {
  return html`<p class="l-error">The presenter has removed you.
    <button onClick=${() => location.reload()}>Join again</button></p>`;
}

/** How often the page has tried when it offers to try at once. */
const MANY = 3;

/** @param {import("./retries.js").State} state */
function Lost({ tries, status, ended }) {
  useRow(WAITING);
  const count = heldBack().length;
  const waits =
    count > 1
      ? ` ${count} changes wait and are sent then.`
      : count
        ? " A change waits and is sent then."
        : "";
  const words =
    status === 401
      ? "The program was started again with another link. Ask for the new one: its terminal shows it."
      : ended
        ? "Connection lost. The program does not answer."
        : stopped
          ? `The server restarts, or has stopped. This page comes back by itself.${waits}`
          : `Connection lost. Trying again…${waits}`;
  return html`<p class="l-error">${words}
    ${
      (ended || status === 401 || tries > MANY) &&
      html`<button onClick=${() => retries.now()}>Try again</button>`
    }</p>`;
}

/** @param {{text: string, lost: string[], other: Memory["file"] | null, before: Memory}} props */
function Back({ text, lost, other, before }) {
  const file = useData("file/state") || {};
  const same = file.name === other?.name && file.folder === other?.folder;
  const can = other && !same && other.own && other.folder === file.folder && hasDisk();
  return html`<p class=${lost.length || other ? "l-warn" : "l-ok"}>${text}
    ${lost.length > 0 && ` Lost: ${listed(lost)}.`}
    ${other && !same && file.name === other.name && ` Another ${file.name} is open now, in another folder.`}
    ${other && !same && file.name !== other.name && ` The config ${file.name || "without a file"} is open now; before, it was ${other.name}.`}
    ${can && html`<button onClick=${() => openAgain(before)}>Open ${other.name}</button>`}
    ${(lost.length > 0 || other) && html`<button onClick=${() => said.set(null)}>OK</button>`}</p>`;
}

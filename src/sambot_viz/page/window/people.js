// @ts-check
/* Who drives and who watches: what the status bar says, how a user asks for the wheel,
 * how a presenter gives it, and how a user goes on with a copy of their own. */

import { html, useRef } from "../vendor/preact.js";
import { act, rows } from "../wire/channel.js";
import { Popup } from "./popup.js";
import { Cell, useData } from "../state.js";

/**
 * @typedef {{browsers: number, presented: boolean, drive: string[], watching: number,
 *   asks: [number, string][], given: boolean, copy: boolean}} State
 * @typedef {{name: string, presenter: boolean, drives: boolean, asks: boolean}} Me
 */

/** What the presenter reads when this user asks. @type {Cell<string>} */
const ownName = new Cell("", "name");

/** Rows that this user may not set look and act like those that cannot be set. */
export function followRole() {
  const look = () => {
    const me = /** @type {Me | undefined} */ (rows.data("role/me"));
    if (!me) return;
    rows.watch(!me.drives);
    document.body.classList.toggle("watching", !me.drives);
  };
  rows.listen("role/me", look);
  look();
}

/** @returns {{state: State, me: Me} | null} */
function usePeople() {
  const state = useData("people/state"),
    me = useData("role/me");
  return state && me ? { state, me } : null;
}

/** In the status bar: who drives, and what can be done about it. */
export function People() {
  const now = usePeople();
  if (!now) return null;
  const { state, me } = now;
  if (!state.copy && !state.presented && state.browsers < 2) return null;
  return html`<${Popup} name="People" role="dialog" title=${inWords(state, me)} label=${short(state, me)}>${(
    /** @type {() => void} */ close,
  ) =>
    html`<div class="people">
      <p>${inWords(state, me)}</p>
      ${state.presented && html`<${Wheel} state=${state} me=${me} close=${close} />`}
      ${
        state.copy
          ? html`<button onClick=${() => location.assign("../")}>Back to the shared robot</button>`
          : !me.presenter &&
            html`<button onClick=${() => location.assign("copy/")}
            title="What you do there, only you see; you can come back at any time">Work on a copy of my own</button>`
      }
    </div>`}<//>`;
}

/** @param {State} state @param {Me} me */
function short(state, me) {
  if (state.copy) return "My copy";
  if (!state.presented) return `${state.browsers} browsers`;
  const asking = me.presenter && state.asks.length ? `, ${state.asks.length} asking` : "";
  return `${whoDrives(state, me)}, ${state.watching} watching${asking}`;
}

/** @param {State} state @param {Me} me */
function whoDrives(state, me) {
  const others = me.drives ? state.drive.filter((name) => name !== me.name) : state.drive;
  const who = me.drives ? ["You", ...others] : others;
  return `${who.length ? who.join(" and ") : "Nobody"} ${me.drives || who.length > 1 ? "drive" : "drives"}`;
}

/** @param {State} state @param {Me} me */
function inWords(state, me) {
  if (state.copy) return "This is a copy of your own: only you see what you do with it.";
  if (!state.presented) return `${state.browsers} pages show this robot, and each can move it.`;
  return `${whoDrives(state, me)}; ${state.watching || "nobody"} ${state.watching > 1 ? "watch" : "watches"}.`;
}

/** @param {{state: State, me: Me, close: () => void}} props */
function Wheel({ state, me, close }) {
  const name = useRef(/** @type {any} */ (null));
  if (me.presenter) {
    return html`<${AskList} asks=${state.asks} />
      ${state.given && html`<button onClick=${() => act("role/take")}>Take the wheel back</button>`}`;
  }
  if (me.drives)
    return html`<button onClick=${() => act("role/back")}>Give the wheel back</button>`;
  if (me.asks) {
    return html`<p>You have asked for the wheel.</p>
      <button onClick=${() => act("role/back")}>Do not ask any more</button>`;
  }
  const ask = () => {
    ownName.set(name.current.value.trim());
    act("role/ask", [ownName.value]);
    close();
  };
  return html`<form onSubmit=${(/** @type {Event} */ e) => {
    e.preventDefault();
    ask();
  }}>
    <label>Your name <input class="field" maxlength="40" placeholder=${me.name} ref=${name} defaultValue=${ownName.value} /></label>
    <button type="submit">Ask for the wheel</button>
  </form>`;
}

/** @param {{asks: [number, string][]}} props */
function AskList({ asks }) {
  return html`${asks.map(
    ([id, name]) => html`<p class="ask" key=${id}>${`${name} asks for the wheel.`}
    <button onClick=${() => act("role/give", [id])} aria-label=${`Give the wheel to ${name}`}>Give</button>
    <button onClick=${() => act("role/refuse", [id])} aria-label=${`Not now, ${name}`}>Not now</button></p>`,
  )}`;
}

/** Over the view of a presenter: who asks. */
export function Asking() {
  const now = usePeople();
  const asks = now?.me.presenter ? now.state.asks : [];
  return html`<div class="asking" role="status" aria-live="polite"><${AskList} asks=${asks} /></div>`;
}

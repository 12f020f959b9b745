// @ts-check
/* The presenter and the viewers: what the status bar says, how a viewer requests control,
 * how a presenter gives it, and how a user opens a private copy. */

import { html, useRef } from "../vendor/preact.js";
import { act, rows } from "../wire/channel.js";
import { Popup } from "./popup.js";
import { Cell, useData } from "../state.js";

/**
 * @typedef {{clients: number, presented: boolean, control: string[], viewers: number,
 *   requests: [number, string][], given: boolean, copy: boolean}} State
 * @typedef {{name: string, presenter: boolean, control: boolean, requests: boolean}} Me
 */

/** The name under which this user requests control. @type {Cell<string>} */
const ownName = new Cell("", "name");

/** Rows that this user may not set look and act like those that cannot be set. */
export function followRole() {
  const look = () => {
    const me = /** @type {Me | undefined} */ (rows.data("role/me"));
    if (!me) return;
    rows.watch(!me.control);
    document.body.classList.toggle("view-only", !me.control);
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

/** In the status bar: who is in control, and what can be done about it. */
export function People() {
  const now = usePeople();
  if (!now) return null;
  const { state, me } = now;
  if (!state.copy && !state.presented && state.clients < 2) return null;
  return html`<${Popup} name="People" role="dialog" title=${inWords(state, me)}
    label=${short(state, me)}>${(/** @type {() => void} */ close) =>
      html`<div class="people">
      <p>${inWords(state, me)}</p>
      ${state.presented && html`<${Control} state=${state} me=${me} close=${close} />`}
      ${
        state.copy
          ? html`<button onClick=${() => location.assign("../")}>Back to the shared robot</button>`
          : !me.presenter &&
            html`<button onClick=${() => location.assign("copy/")}
            title="Only you see what you change there. You can return at any time."
            >Make my own copy</button>`
      }
    </div>`}<//>`;
}

/** @param {number} number @param {string} noun */
const count = (number, noun) => `${number || "no"} ${noun}${number === 1 ? "" : "s"}`;

/** @param {State} state @param {Me} me */
function short(state, me) {
  if (state.copy) return "Private copy";
  if (!state.presented) return `${state.clients} browsers`;
  const requests =
    me.presenter && state.requests.length ? `, ${count(state.requests.length, "request")}` : "";
  return `${inControl(state, me)}, ${count(state.viewers, "viewer")}${requests}`;
}

/** @param {State} state @param {Me} me */
function inControl(state, me) {
  const others = me.control ? state.control.filter((name) => name !== me.name) : state.control;
  const who = me.control ? ["You", ...others] : others;
  const verb = me.control || who.length > 1 ? "are" : "is";
  return `${who.join(" and ") || "Nobody"} ${verb} in control`;
}

/** @param {State} state @param {Me} me */
function inWords(state, me) {
  if (state.copy) return "This is a private copy. Only you see what you change.";
  if (!state.presented) return `${state.clients} pages show this robot, and each can control it.`;
  return `${inControl(state, me)}. ${count(state.viewers, "viewer")}.`;
}

/** @param {{state: State, me: Me, close: () => void}} props */
function Control({ state, me, close }) {
  /** @type {Ref<HTMLInputElement>} */
  const name = useRef(null);
  if (me.presenter) {
    return html`<div class="requests"><${AskList} requests=${state.requests} /></div>
      ${
        state.given &&
        html`<button
        onClick=${() => act("role/take-back")}>Take back control</button>`
      }`;
  }
  if (me.control)
    return html`<button onClick=${() => act("role/release")}>Release control</button>`;
  if (me.requests) {
    return html`<p>You have requested control.</p>
      <button onClick=${() => act("role/release")}>Cancel the request</button>`;
  }
  const ask = () => {
    ownName.set(name.current.value.trim());
    act("role/request", [ownName.value]);
    close();
  };
  return html`<form onSubmit=${(/** @type {Event} */ e) => {
    e.preventDefault();
    ask();
  }}>
    <label>Your name <input class="field" maxlength="40" placeholder=${me.name} ref=${name}
      defaultValue=${ownName.value} /></label>
    <button type="submit">Request control</button>
  </form>`;
}

/** @param {{requests: [number, string][]}} props */
function AskList({ requests }) {
  return html`${requests.map(
    ([id, name]) => html`<p class="ask" key=${id}>${`${name} requests control.`}
    <button onClick=${() => act("role/give", [id])}
      aria-label=${`Give control to ${name}`}>Give control</button>
    <button onClick=${() => act("role/decline", [id])}
      aria-label=${`Not now, ${name}`}>Not now</button></p>`,
  )}`;
}

/** How many requests are shown over the view, each with its buttons. */
const OVER_VIEW = 2;

/** Over the view of a presenter: the requests for control, all but the first in one line. */
export function Asking() {
  const now = usePeople();
  const asks = now?.me.presenter ? now.state.requests : [];
  const many = asks.length > OVER_VIEW,
    rest = many ? asks.slice(1) : [];
  const decline = () => rest.forEach(([id]) => act("role/decline", [id]));
  return html`<div class="asking" role="status" aria-live="polite">
    <${AskList} requests=${many ? asks.slice(0, 1) : asks} />
    ${
      many &&
      html`<p class="ask">${`${rest.length} more request control; all are in the list below.`}
      <button onClick=${decline} aria-label=${`Not now, these ${rest.length}`}>Not now</button></p>`
    }</div>`;
}

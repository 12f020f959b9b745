// @ts-check
/* The presenter and the viewers: what the status bar says, what a viewer's page says at its top,
 * and the requests for control over the view of a presenter. Who is there is in the dialog of the
 * status bar (dialogs/people.js). */

import { html } from "../vendor/preact.js";
import { act, FOLLOWS } from "../wire/channel.js";
import { PeopleList } from "../dialogs/people.js";
import { Icon } from "./icons.js";
import { Popup } from "./popup.js";
import { useCommand, useData } from "../state.js";
import { ownName, peopleOpen, turnInWords, usePeople } from "./users.js";

/**
 * @typedef {import("./users.js").Now} Now
 */

/** In the status bar: who is in control, and what can be done about it. */
export function People() {
  const now = usePeople(),
    follows = useData(FOLLOWS);
  if (!now) return null;
  const { state, me, people } = now;
  if (!state.copy && !state.presented && people.length < 2 && !state.copies) return null;
  return html`<${Popup} name="People" role="dialog" title=${inWords(now)} opened=${peopleOpen}
    label=${short(now)} brief=${html`<${Icon} name="people" /> ${people.length}`}
    >${(/** @type {() => void} */ close) =>
      html`<div class="people">
      <p>${inWords(now)}</p>
      ${!state.copy && html`<${PeopleList} now=${now} close=${close} />`}
      ${
        state.copy
          ? html`<button onClick=${goBack}>Back to the shared robot</button>`
          : !me.presenter &&
            !follows &&
            html`<button onClick=${() => location.assign(`copy/${location.search}`)}
            title="Only you see what you change there. You can return at any time."
            >Make my own copy</button>`
      }
    </div>`}<//>`;
}

const goBack = () => location.assign(`../${location.search}`);

/** @param {number} copies @param {string} joint what is between it and what is said before */
const withCopies = (copies, joint) =>
  copies ? `${joint}${copies} private ${copies === 1 ? "copy" : "copies"}` : "";

/** @param {number} number @param {string} noun */
const count = (number, noun) => `${number || "No"} ${noun}${number === 1 ? "" : "s"}`;

/** @param {Now} now */
function short(now) {
  const { state, me, people, viewers, requests } = now;
  if (state.copy) return "Private copy";
  const away = withCopies(state.copies, ", ");
  if (!state.presented) return `${count(people.length, "browser")}${away}`;
  const asking = me.presenter && requests.length ? `, ${count(requests.length, "request")}` : "";
  const seen = viewers ? `, ${count(viewers, "viewer")}` : "";
  return `${inControl(now)}${seen}${away}${asking}`;
}

/** @param {Now} now */
function inControl({ me, people }) {
  const others = people.filter(({ control, client }) => control && client !== me.client);
  const names = others.map(({ name }) => name).sort();
  const who = me.control ? ["You", ...names] : names;
  const verb = me.control || who.length > 1 ? "control" : "controls";
  const list =
    who.length > 2 ? `${who.slice(0, -1).join(", ")} and ${who.at(-1)}` : who.join(" and ");
  return `${list || "Nobody"} ${verb} the robot`;
}

/** @param {Now} now */
function inWords(now) {
  if (now.state.copy) return "This is a private copy. Only you see what you change.";
  const away = withCopies(now.state.copies, "; ");
  if (!now.state.presented)
    return `${now.people.length} pages show this robot, and each can control it${away}.`;
  return `${inControl(now)}. ${count(now.viewers, "viewer")}${away}.`;
}

/** How many requests are shown over the view, each with its buttons. */
const OVER_VIEW = 2;

/** Over the view: the requests for control, for a presenter; that others control the robot, for
 * a viewer; the way back, in a private copy. */
export function Asking() {
  const now = usePeople();
  // With turns, control passes by itself.
  const asks = now?.me.presenter && !now.state.slot ? now.requests : [];
  const chip = now && !now.me.control && !peopleOpen.use();
  return html`<div class="asking" role="status" aria-live="polite">
    ${
      now?.state.copy &&
      html`<button class="chip" onClick=${goBack}>
      Private copy · Back to the shared robot</button>`
    }
    ${chip && html`<${ViewOnly} now=${now} />`}
    ${
      asks.length > OVER_VIEW
        ? html`<p class="ask">${`${asks.length} people request control.`}
      <button onClick=${() => peopleOpen.set(true)}>Show them</button>
      <button onClick=${() => act("role/decline-all")}
        aria-label=${`Not now, all ${asks.length}`}>Not now</button></p>`
        : asks.map(
            ({ client, name }) => html`<p class="ask" key=${client}>${`${name} requests control.`}
      <button onClick=${() => act("role/give", [client])}
        aria-label=${`Give control to ${name}`}>Give control</button>
      <button onClick=${() => act("role/decline", [client])}
        aria-label=${`Not now, ${name}`}>Not now</button></p>`,
          )
    }</div>`;
}

/** One click requests control; what has been requested is cancelled in the dialog.
 * @param {{now: Now}} props */
function ViewOnly({ now: { me, people } }) {
  const may = useCommand("role/request"),
    follows = useData(FOLLOWS);
  if (follows?.origin)
    return html`<a class="chip" href=${follows.origin} target="_blank" rel="noopener noreferrer"
      title="Opens the page of the server that this one follows"
      >View only · Request control</a>`;
  if (!may) return html`<span class="chip">View only</span>`;
  const turn = people.find(({ client, place }) => place && client === me.client);
  const click = () => (me.requests ? peopleOpen.set(true) : act("role/request", [ownName.value]));
  return html`<button class="chip" onClick=${click}>
    ${`View only · ${turn ? turnInWords(turn) : me.requests ? "Control requested" : "Request control"}`}</button>`;
}

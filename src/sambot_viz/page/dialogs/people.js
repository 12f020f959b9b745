// @ts-check
/* Who is there: a row for each, with the presenter's commands, and what this user may ask for. */

import { html, useLayoutEffect, useRef, useState } from "../vendor/preact.js";
import { act, FOLLOWS } from "../wire/channel.js";
import { Icon } from "../window/icons.js";
import { ownName, timeInWords, turnInWords } from "../window/users.js";
import { show } from "./dialog.js";
import { Invite } from "./invite.js";
import { useCommand, useData } from "../state.js";

/**
 * @typedef {import("../window/users.js").Now} Now
 * @typedef {import("../window/users.js").Person} Person
 */

/** @param {{now: Now, close: () => void}} props */
export function PeopleList({ now, close }) {
  const { state, me, people, requests } = now;
  const canInvite = useCommand("people/invite");
  const follows = useData(FOLLOWS);
  const canAsk = useCommand("role/request") && !follows;
  return html`
    ${state.presented && !me.presenter && canAsk && html`<${Control} now=${now} close=${close} />`}
    <ul aria-label="Everyone">${people.map(
      (person) => html`<${PersonRow} key=${person.id} person=${person} now=${now} />`,
    )}</ul>
    ${
      me.presenter &&
      requests.length > 1 &&
      html`<button onClick=${() => act("role/decline-all")}>Not now, all requests</button>`
    }
    ${
      me.control &&
      people.length > 1 &&
      html`<button onClick=${() => act("views/bring")}
        title="All pages show your view once. Views > Lead all views keeps them there."
        >Bring everyone to my view</button>`
    }
    ${
      canInvite &&
      html`<button onClick=${() => {
        close();
        show(Invite);
      }}>Invite…</button>`
    }`;
}

/** @param {{person: Person, now: Now}} props */
function PersonRow({ person, now: { state, me } }) {
  const [renaming, setRenaming] = useState(false);
  const { client, name } = person;
  const canGive = useCommand("role/give");
  const own = client === me.client,
    leads = canGive && state.presented && me.presenter && !person.presenter;
  const said = state.presented
    ? person.presenter
      ? name.startsWith("Presenter")
        ? ""
        : "presenter"
      : person.control
        ? `in control${state.left ? `, ${timeInWords(state.left)}` : ""}`
        : person.place
          ? turnInWords(person)
          : person.requests
            ? "requests control"
            : ""
    : "";
  if (renaming)
    return html`<${NameField} person=${person} own=${own} end=${() => setRenaming(false)} />`;
  return html`<li class=${person.requests ? "requests" : ""}>
    <span class="who" title=${name}><b>${name}</b>${own && " (you)"}
      ${said && html` <span class="soft">${said}</span>`}</span>
    ${
      leads &&
      (person.control
        ? html`<button onClick=${() => act("role/take-back")}
            aria-label=${`Take back control from ${name}`}>Take back</button>`
        : html`<button onClick=${() => act("role/give", [client])}
            aria-label=${`Give control to ${name}`}>Give control</button>`)
    }
    ${
      leads &&
      person.requests &&
      html`<button onClick=${() => act("role/decline", [client])}
        aria-label=${`Not now, ${name}`}>Not now</button>`
    }
    ${
      (own || leads) &&
      html`<button class="flat" onClick=${() => setRenaming(true)} aria-label=${`Rename ${name}`}
        title="Rename"><${Icon} name="rename" /></button>`
    }
    ${
      leads &&
      html`<button class="flat" onClick=${() => act("role/remove", [client])}
        aria-label=${`Remove ${name}`} title="Remove: close this viewer's page"
        ><${Icon} name="close" /></button>`
    }
  </li>`;
}

/** @param {{person: Person, own: boolean, end: () => void}} props */
function NameField({ person, own, end }) {
  /** @type {Ref<HTMLInputElement>} */
  const field = useRef(null);
  useLayoutEffect(() => field.current.select(), []);
  const save = () => {
    const name = field.current.value.trim();
    if (own && !person.presenter) ownName.set(name);
    if (name && name !== person.name) act("role/rename", [person.client, name]);
    end();
  };
  return html`<li><form onSubmit=${(/** @type {Event} */ event) => {
    event.preventDefault();
    save();
  }} onKeyDown=${(/** @type {Key} */ event) => {
    if (event.key !== "Escape") return;
    event.stopPropagation();
    end();
  }}><input class="field" maxlength="40" ref=${field} defaultValue=${person.name}
      aria-label=${`New name of ${person.name}`} />
    <button type="submit">Rename</button></form></li>`;
}

/** What a viewer can do about control. @param {{now: Now, close: () => void}} props */
function Control({ now: { state, me, people }, close }) {
  /** @type {Ref<HTMLInputElement>} */
  const name = useRef(null);
  if (me.control)
    return html`<button onClick=${() => act("role/release")}>Release control</button>`;
  if (me.requests) {
    const turn = people.find(({ client, place }) => place && client === me.client);
    const said = turn
      ? `You wait for control: ${turnInWords(turn)}.`
      : "You have requested control.";
    return html`<p>${said}</p>
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
    ${
      state.slot &&
      html`<p class="soft">${`Control passes to the next after ${timeInWords(state.slot)}.`}</p>`
    }
    ${!state.slot && !people.some((person) => person.presenter) && html`<p class="soft">No presenter is here now.</p>`}
  </form>`;
}

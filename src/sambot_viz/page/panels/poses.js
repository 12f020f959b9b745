// @ts-check
/* Named poses: choose one, save the present one, remove one. */

import { html, useRef, useState } from "../vendor/preact.js";
import { act } from "../channel.js";
import { Icon } from "../icons.js";
import { refusals } from "../notices.js";
import { Popup } from "../popup.js";
import { useRow } from "../state.js";

export function Poses() {
  if (!useRow("poses")) return null;
  return html`<${Popup} name="Poses" role="dialog" label=${html`Poses <${Icon} name="down" />`} title="Named poses: choose, save, remove">
    ${(/** @type {() => void} */ close) => html`<${Form} close=${close} />`}<//>`;
}

/** @param {{close: () => void}} props */
function Form({ close }) {
  const row = useRow("poses");
  /** @type {string[]} */
  const names = row?.value || [];
  useRow("poses/save");
  const why = refusals.get("poses/save");
  const field = useRef(/** @type {any} */ (null));
  const [typed, setTyped] = useState("");
  const exists = names.includes(typed.trim());
  /** @param {any} event */
  const save = (event) => {
    event.preventDefault();
    act("poses/save", [field.current.value]);
  };
  return html`<div class="poses">
    ${names.map((name) => html`<div class="pose" key=${name}>
      <button title=${`Move the joints to '${name}'`} onClick=${() => { act("poses/use", [name]); close(); }}>${name}</button>
      <button class="flat" aria-label=${`Remove ${name}`} title=${`Remove '${name}'`} onClick=${() => act("poses/remove", [name])}><${Icon} name="close" /></button>
    </div>`)}
    ${!names.length && html`<p class="empty">No pose is saved yet</p>`}
    <form onSubmit=${save}>
      <input class="search" ref=${field} aria-label="Name of the pose" placeholder="Name of this pose" maxlength="60"
        autocomplete="off" spellcheck=${false} onInput=${(/** @type {any} */ e) => setTyped(e.target.value)} />
      <button type="submit" disabled=${!typed.trim()}>${exists ? "Replace" : "Save"}</button>
    </form>
    ${why && html`<p class="why" role="alert">${why}</p>`}
    <p class="place">${row?.help}</p>
  </div>`;
}

// @ts-check
/* Named poses: choose one, save the present one, remove one. */

import { html, useLayoutEffect, useRef, useState } from "../vendor/preact.js";
import { act, rows } from "../wire/channel.js";
import { Icon } from "../window/icons.js";
import { refusals, tell } from "../window/notices.js";
import { Popup } from "../window/popup.js";
import { useData, useRow } from "../state.js";
import { haunt } from "../view/drawn_here.js";

const still = matchMedia("(prefers-reduced-motion: reduce)");
/** Move the joints to a pose. @param {string} name */
const takePose = (name) => act(still.matches ? "poses/use" : "poses/move", [name]);

/** The ghost is made of what the scene has: meshes that come later are looked for so often, after
 * so long each time [ms]. */
const TRIES = 3,
  LATER = 500;

/** Draw the ghost that the server tells of. */
export function followGhost() {
  let turn = 0;
  rows.listen("poses/ghost", () => {
    const ghost = rows.data("poses/ghost");
    const now = ++turn;
    const draw = (/** @type {number} */ left) => {
      if (now !== turn) return;
      const why = haunt(ghost);
      if (why) {
        tell(why, "warn");
        act("poses/show", [""]);
      } else if (left && ghost) setTimeout(() => draw(left - 1), LATER);
    };
    draw(TRIES);
  });
}

export function Poses() {
  if (!useData("poses/names")) return null;
  return html`<${Popup} name="Poses" role="dialog" label=${html`Poses <${Icon} name="down" />`}
    title="Named poses: choose, save, remove">
    ${(/** @type {() => void} */ close) => html`<${Form} close=${close} />`}<//>`;
}

/** @param {{close: () => void}} props */
function Form({ close }) {
  /** @type {string[]} */
  const names = useData("poses/names") || [],
    place = useData("poses/place");
  const ghost = useData("poses/ghost")?.name;
  useRow("poses/save");
  const why = refusals.get("poses/save");
  /** @type {Ref<HTMLInputElement>} */
  const field = useRef(null);
  const [typed, setTyped] = useState("");
  const exists = names.includes(typed.trim());
  /** @param {Press} event */
  const save = (event) => {
    event.preventDefault();
    act("poses/save", [field.current.value]);
  };
  // The button that has removed a pose goes with it: the next one has the focus, or the field.
  /** @type {Ref} */
  const list = useRef(null);
  const removed = useRef(-1);
  /** @param {string} name */
  const remove = (name) => {
    removed.current = names.indexOf(name);
    act("poses/remove", [name]);
  };
  useLayoutEffect(() => {
    const buttons = list.current.querySelectorAll(".pose .remove");
    if (removed.current >= 0)
      (buttons[Math.min(removed.current, buttons.length - 1)] || field.current).focus();
    removed.current = -1;
  }, [names.join("\n")]);
  return html`<div class="poses" ref=${list}>
    ${names.map(
      (name) => html`<div class="pose" key=${name}>
      <button class="needs-control" title=${`Move the joints to '${name}'`} onClick=${() => {
        takePose(name);
        close();
      }}>${name}</button>
      <button class="flat" aria-label=${`Show ${name} as ghost`}
        aria-pressed=${String(ghost === name)}
        title=${ghost === name ? "End the ghost" : `Show '${name}' as a ghost, in this browser alone`}
        onClick=${() => act("poses/show", [ghost === name ? "" : name])}><${Icon} name="view" />
        </button>
      <button class="flat remove" aria-label=${`Remove pose ${name}`} title=${`Remove pose ${name}`}
        onClick=${() => remove(name)}><${Icon} name="trash" /></button>
    </div>`,
    )}
    ${!names.length && html`<p class="empty">No poses saved yet</p>`}
    <form onSubmit=${save}>
      <input class="search" ref=${field} aria-label="Name of the pose"
        placeholder="Name of this pose" maxlength="60"
        autocomplete="off" spellcheck=${false}
          onInput=${(/** @type {Change} */ e) => setTyped(e.target.value)} />
      <button class="needs-control" type="submit" disabled=${!typed.trim()}>${exists ? "Replace" : "Save"}
      </button>
    </form>
    ${why && html`<p class="validation" role="alert">${why}</p>`}
    <p class="place">${place}</p>
  </div>`;
}

// @ts-check
/* Save Config As: a name and Enter; a file that exists is replaced after a question. */

import { html, useEffect, useLayoutEffect, useRef, useState } from "../vendor/preact.js";
import { act, rows } from "../wire/channel.js";
import { unfolded } from "../state.js";
import { Dialog, useAnswer } from "./dialog.js";

/** @param {{close: () => void, then?: () => void}} props */
export function SaveAs({ close, then }) {
  const state = rows.data("file/state") || {};
  /** @type {Ref<HTMLInputElement>} */
  const field = useRef(null);
  const [wanted, setWanted] = useState("");
  const { refused, answer, begin } = useAnswer("file/save-as");
  // Before the first key that is typed.
  useLayoutEffect(() => {
    field.current.value = state.own ? state.name.replace(/\.rviz$/, "") : "";
    field.current.select();
  }, []);
  useEffect(() => {
    if (answer?.done) {
      close();
      then?.();
    }
  }, [answer?.number]);
  useEffect(() => {
    if (refused) field.current.focus();
  }, [refused]);
  /** @param {boolean} replace */
  const save = (replace) => {
    begin();
    setWanted(field.current.value);
    act("file/save-as", [field.current.value, replace, unfolded()]);
  };
  const exists = answer?.exists;
  return html`<${Dialog} title="Save Config As" close=${close} submit=${() => save(false)}>
    <p>In the folder <b class="path">${state.folder}</b></p>
    <label class="line">Name <input data-first aria-label="Name" ref=${field} spellcheck=${false}
      autocomplete="off"
      aria-invalid=${refused ? "true" : undefined} placeholder="my_robot" onInput=${() => {
        begin();
        setWanted("");
      }} />
      <span class="ending">.rviz</span></label>
    ${refused && html`<p class="refused" role="alert">${refused}</p>`}
    ${
      exists &&
      wanted &&
      html`<p class="question" role="alert">
      ${`${exists} already exists. Replace it?`}</p>`
    }
    <div class="buttons end">
      ${
        exists && wanted
          ? html`<${Question} replace=${() => save(true)} cancel=${close} />`
          : html`<button type="submit" class="main">Save</button>
            <button type="button" onClick=${close}>Cancel</button>`
      }
    </div>
  </${Dialog}>`;
}

/** The answers to the question; an Enter too many replaces nothing.
 * @param {{replace: () => void, cancel: () => void}} props */
function Question({ replace, cancel }) {
  /** @type {Ref} */
  const button = useRef(null);
  useLayoutEffect(() => button.current.focus(), []);
  return html`<button type="button" onClick=${replace}>Replace</button>
    <button type="button" class="main" ref=${button} onClick=${cancel}>Cancel</button>`;
}

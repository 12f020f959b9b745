// @ts-check
/* Open Config: the .rviz files of the folder; asks first what becomes of unsaved changes. */

import { html, useEffect, useLayoutEffect, useRef, useState } from "../vendor/preact.js";
import { act } from "../wire/channel.js";
import { unfolded, useData } from "../state.js";
import { Dialog, show, useAnswer } from "./dialog.js";
import { SaveAs } from "./save_as.js";

/** @param {{close: () => void}} props */
export function OpenConfig({ close }) {
  const state = useData("file/state") || {};
  const [discard, setDiscard] = useState(false);
  const [saving, setSaving] = useState(false);
  if (!state.modified || discard)
    return html`<${Choose} close=${close} folder=${state.folder} name=${state.own ? state.name : ""}
      />`;
  const save = () => {
    // The list comes as soon as the file is saved.
    if (state.own) {
      setSaving(true);
      act("file/save", [unfolded()]);
    } else
      show(({ close: shut }) => html`<${SaveAs} close=${shut} then=${() => show(OpenConfig)} />`);
  };
  return html`<${Dialog} title="Unsaved changes" close=${close} submit=${save}>
    <p>${`${state.name || "This config"} has unsaved changes. Save them before opening another config?`}</p>
    <${SaveRefused} saving=${saving} />
    <div class="buttons end">
      <button type="submit" class="main" data-first>${state.own ? "Save" : "Save as…"}</button>
      <button type="button" onClick=${() => setDiscard(true)}>Don’t save</button>
      <button type="button" onClick=${close}>Cancel</button>
    </div>
  </${Dialog}>`;
}

/** @param {{saving: boolean}} props */
function SaveRefused({ saving }) {
  const { refused } = useAnswer("file/save");
  return saving && refused ? html`<p class="refused" role="alert">${refused}</p>` : null;
}

/** @param {{close: () => void, folder: string, name: string}} props */
function Choose({ close, folder, name }) {
  /** @type {Ref<HTMLSelectElement>} */
  const list = useRef(null);
  const [asked, setAsked] = useState(false);
  const { refused, answer, begin } = useAnswer("file/open");
  const names = useData("file/names");
  useEffect(() => {
    act("file/list");
    setAsked(true);
  }, []);
  useLayoutEffect(() => {
    if (list.current && list.current.selectedIndex < 0)
      list.current.selectedIndex = Math.max(0, (names || []).indexOf(name));
    list.current?.focus();
  }, [names]);
  useEffect(() => {
    if (answer?.done) close();
  }, [answer?.number]);
  const open = () => {
    if (!list.current?.value) return;
    begin();
    act("file/open", [list.current.value]);
  };
  return html`<${Dialog} title="Open Config" close=${close} submit=${open}>
    <p>In the folder <b class="path">${folder}</b></p>
    <div class="configs">${
      names?.length
        ? html`<select size="10" aria-label="Configs"
          ref=${list} data-first
        onDblClick=${open} onKeyDown=${(/** @type {Key} */ e) => {
          if (e.key === "Enter") {
            e.preventDefault();
            open();
          }
        }}>
        ${names.map(
          (/** @type {string} */ one) => html`<option key=${one} value=${one}>${one}
          </option>`,
        )}
      </select>`
        : html`<p class="empty">
          ${asked && names ? "This folder has no .rviz files." : "Reading the folder…"}</p>`
    }</div>
    ${refused && html`<p class="refused" role="alert">${refused}</p>`}
    <div class="buttons end">
      <button type="submit" class="main" disabled=${!names?.length}>Open</button>
      <button type="button" onClick=${close}>Cancel</button>
    </div>
  </${Dialog}>`;
}

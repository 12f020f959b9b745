// @ts-check
/* Open Config and Open Recording: what is in the folders that were opened; asks first what becomes
 * of unsaved changes. */

import { html, useEffect, useLayoutEffect, useRef, useState } from "../vendor/preact.js";
import { act, rows } from "../wire/channel.js";
import { unfolded, useData } from "../state.js";
import { Dialog, show, useAnswer } from "./dialog.js";
import { SaveAs } from "./save_as.js";

/** @param {{close: () => void}} props */
export function OpenConfig({ close }) {
  return html`<${AskFirst} what="another config" close=${close} dialog=${OpenConfig}>
    <${Config} close=${close} /></${AskFirst}>`;
}

/** A config that was open before; what becomes of unsaved changes is asked first.
 * @param {{name: string, close: () => void}} props */
export function OpenAgain({ name, close }) {
  const again = (/** @type {{close: () => void}} */ { close: shut }) =>
    html`<${OpenAgain} name=${name} close=${shut} />`;
  return html`<${AskFirst} what="another config" close=${close} dialog=${again}>
    <${Again} name=${name} close=${close} /></${AskFirst}>`;
}

/** Opens at once; a dialog comes only to say why not. @param {{name: string, close: () => void}} props */
function Again({ name, close }) {
  const { refused, answer, begin } = useAnswer("file/open");
  useEffect(() => {
    begin();
    act("file/open", [name]);
  }, []);
  useEffect(() => {
    if (answer?.done) close();
  }, [answer?.number]);
  if (!refused) return null;
  return html`<${Dialog} title="Open Config" close=${close} submit=${close}>
    <p>${name}</p>
    <p class="refused" role="alert">${refused}</p>
    <div class="buttons end"><button type="submit" class="main" data-first>Close</button></div>
  </${Dialog}>`;
}

/** Another recording leaves a config alone; one of nobody gives way to that of the recording.
 * @param {{close: () => void}} props */
export function OpenRecording({ close }) {
  const recording = html`<${Recording} close=${close} />`;
  if (!useData("recording/state")?.replaces) return recording;
  return html`<${AskFirst} what="another recording" close=${close} dialog=${OpenRecording}>
    ${recording}</${AskFirst}>`;
}

/** A question, where there are unsaved changes; then what is in it.
 * @param {{what: string, close: () => void, dialog: (props: {close: () => void}) => any,
 *   children?: any}} props */
function AskFirst({ what, close, dialog, children }) {
  const state = useData("file/state") || {};
  const [discard, setDiscard] = useState(false);
  const [saving, setSaving] = useState(false);
  if (!state.modified || discard) return children;
  const save = () => {
    // The list comes as soon as the file is saved.
    if (state.own) {
      setSaving(true);
      act("file/save", [unfolded()]);
    } else show(({ close: shut }) => html`<${SaveAs} close=${shut} then=${() => show(dialog)} />`);
  };
  const canSave = rows.knows("file/save");
  return html`<${Dialog} title="Unsaved changes" close=${close}
    submit=${canSave ? save : () => setDiscard(true)}>
    <p>${`${state.name || "This config"} has unsaved changes. ${
      canSave ? "Save them" : "Lose them"
    } before opening ${what}?`}</p>
    <${SaveRefused} saving=${saving} />
    <div class="buttons end">
      ${
        canSave
          ? html`<button type="submit" class="main" data-first>${state.own ? "Save" : "Save as…"}</button>
            <button type="button" onClick=${() => setDiscard(true)}>Don’t save</button>`
          : html`<button type="submit" data-first>Lose them</button>`
      }
      <button type="button" onClick=${close}>Cancel</button>
    </div>
  </${Dialog}>`;
}

/** @param {{saving: boolean}} props */
function SaveRefused({ saving }) {
  const { refused } = useAnswer("file/save");
  return saving && refused ? html`<p class="refused" role="alert">${refused}</p>` : null;
}

/** @param {{close: () => void}} props */
function Config({ close }) {
  const { folder, own, name } = useData("file/state") || {};
  const { refused, answer, begin } = useAnswer("file/open");
  useEffect(() => {
    if (answer?.done) close();
  }, [answer?.number]);
  /** @param {string} chosen */
  const open = (chosen) => {
    begin();
    act("file/open", [chosen]);
  };
  return html`<${Choose} title="Open Config" label="Configs" close=${close} open=${open}
    list="file/list" names=${useData("file/names")} first=${own ? name : ""} refused=${refused}
    none="This folder has no .rviz files.">
    <p>In the folder <b class="path">${folder}</b></p>
  </${Choose}>`;
}

/** @param {{close: () => void}} props */
function Recording({ close }) {
  /** @type {string[]} */
  const parts = useData("recording/state")?.parts || [];
  const [chosen, setPart] = useState("");
  const part = parts.includes(chosen) ? chosen : parts[0] || "";
  const { refused, answer, begin } = useAnswer("recording/open");
  useEffect(() => {
    if (answer?.done) close();
  }, [answer?.number]);
  /** @param {string} name */
  const open = (name) => {
    begin();
    act("recording/open", [part, name]);
  };
  return html`<${Choose} title="Open Recording" label="Recordings" close=${close} open=${open}
    list="recording/list" names=${useData("recording/names")} first=${part}
    refused=${refused || answer?.refused} busy=${answer?.opening}
    none="There is no other recording beside the one that was opened.">
    ${
      parts.length > 1 &&
      html`<label class="line">In place of <select value=${part}
      onChange=${(/** @type {any} */ e) => setPart(e.currentTarget.value)}>${parts.map(
        (one) => html`<option key=${one} value=${one}>${one}</option>`,
      )}</select></label>`
    }
  </${Choose}>`;
}

/**
 * A list of names, of which one is opened.
 * @param {{title: string, label: string, close: () => void, open: (name: string) => void,
 *   list: string, names: string[] | undefined, first: string, none: string, refused?: string,
 *   busy?: string, children?: any}} props list: the command that asks for the names; first: the
 *   one that is shown; busy: the one that is being opened
 */
function Choose({ title, label, close, open, list, names, first, none, refused, busy, children }) {
  /** @type {Ref<HTMLSelectElement>} */
  const element = useRef(null);
  const [asked, setAsked] = useState(false);
  useEffect(() => {
    act(list);
    setAsked(true);
  }, []);
  useLayoutEffect(() => {
    if (element.current && element.current.selectedIndex < 0)
      element.current.selectedIndex = Math.max(0, (names || []).indexOf(first));
    element.current?.focus();
  }, [names]);
  const choose = () => {
    if (element.current?.value && !busy) open(element.current.value);
  };
  return html`<${Dialog} title=${title} close=${close} submit=${choose}>
    ${children}
    <div class="configs">${
      names?.length
        ? html`<select size="10" aria-label=${label}
          ref=${element} data-first
        onDblClick=${choose} onKeyDown=${(/** @type {Key} */ e) => {
          if (e.key === "Enter") {
            e.preventDefault();
            choose();
          }
        }}>
        ${names.map(
          (/** @type {string} */ one) => html`<option key=${one} value=${one}>${one}
          </option>`,
        )}
      </select>`
        : html`<p class="empty">
          ${asked && names ? none : "Reading the folder…"}</p>`
    }</div>
    ${busy && !refused && html`<p role="status">${`Opening ${busy} …`}</p>`}
    ${refused && html`<p class="refused" role="alert">${refused}</p>`}
    <div class="buttons end">
      <button type="submit" class="main" disabled=${!names?.length || Boolean(busy)}>Open</button>
      <button type="button" onClick=${close}>Cancel</button>
    </div>
  </${Dialog}>`;
}

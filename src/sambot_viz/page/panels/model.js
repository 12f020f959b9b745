// @ts-check
/* The Model panel: the files of the model as tabs, and the text of one of them. */

import { html, useEffect, useRef, useState } from "../vendor/preact.js";
import { act } from "../wire/channel.js";
import { Editor } from "../editor/editor.js";
import { Expanded } from "../editor/expanded.js";
import { loadCodeMirror } from "../editor/look.js";
import { ModelConflict } from "./model_conflict.js";
import { ModelNumbers } from "./model_numbers.js";
import { useCommand, useData } from "../state.js";

/** @typedef {{name: string, changed: boolean, errors: number, warnings: number}} File */

export function ModelPanel() {
  const shown = useData("model/shown");
  // The text is sent only while somebody can see it.
  useEffect(() => {
    if (shown === false) act("model/show", [true]);
  }, [shown]);
  useEffect(() => () => act("model/show", [false]), []);
  /** @type {Ref} */
  const host = useRef(null);
  const [editor, setEditor] = useState(/** @type {Editor | null} */ (null));
  const [failed, setFailed] = useState("");
  useEffect(() => {
    let made = /** @type {Editor | null} */ (null);
    let left = false;
    loadCodeMirror().then(
      (cm) => {
        if (left) return;
        made = new Editor(cm, host.current);
        setEditor(made);
      },
      (error) => setFailed(`The editor cannot be loaded: ${error.message}`),
    );
    return () => {
      left = true;
      made?.close();
    };
  }, []);
  const content = useData("model/text");
  const [expanded, expand] = useState(false);
  // A click in the view asks for a place in a file.
  const wanted = useData("model/wanted")?.number;
  useEffect(() => expand(false), [wanted]);
  const why = content?.why && `This file cannot be shown: ${content.why}.`;
  return html`<div class="model">
    <${ModelNumbers} write=${editor ? () => editor.ask("model/write") : undefined} />
    <${Files} editor=${editor} open=${content?.file} expanded=${expanded} expand=${expand} />
    <${NewFile} open=${content?.file} editor=${editor} />
    ${(failed || why) && html`<p class="note l-error">${failed || why}</p>`}
    <${ModelConflict} editor=${editor} content=${content} />
    <${Called} file=${content?.file} />
    <div class=${`text${why ? " away" : ""}${expanded ? " off" : ""}`} ref=${host}></div>
    ${expanded && html`<${Expanded} />`}
    <${Buttons} editor=${editor} content=${content} />
  </div>`;
}

/** @param {{editor: Editor | null, open: string, expanded: boolean,
 *   expand: (on: boolean) => void}} props expanded: the model without xacro is shown */
function Files({ editor, open, expanded, expand }) {
  /** @type {File[]} */
  const files = useData("model/files") || [];
  const has = useCommand("model/expand");
  /** @param {string} name */
  const show = (name) => {
    expand(false);
    editor?.show(name);
  };
  return html`<div class="files" role="tablist" aria-label="Files of the model">
    ${files.map(
      ({ name, changed, errors, warnings }) => html`<button role="tab" key=${name}
        aria-selected=${String(name === open && !expanded)} title=${name} onClick=${() => show(name)}>
        ${name.split("/").pop()}
        ${changed && html`<span class="changed" title="Not saved" aria-label="not saved">●</span>`}
        ${
          errors + warnings > 0 &&
          html`<span class=${errors ? "l-error" : "l-warn"}>${errors || warnings}</span>`
        }</button>`,
    )}
    ${
      has &&
      html`<button role="tab" class="expanded" aria-selected=${String(expanded)}
        title="The model without xacro, as ROS gets it; it follows what is typed"
        onClick=${() => expand(true)}>Expanded</button>`
    }
  </div>`;
}

/** Where the macro is called that makes the link that was clicked on.
 * @param {{file: string}} props */
function Called({ file }) {
  const { link, call, file: of } = useData("model/wanted") || {};
  if (!call || of !== file) return null;
  return html`<div class="note beside-buttons" role="status">
    <span>A macro makes ${link}; it is called in ${call}.</span>
    <button onClick=${() => act("model/call", [link])}>Go to the call</button>
  </div>`;
}

/** Asks for the name of a new file, where files may be added, until the file is there.
 * @param {{open: string | undefined, editor: Editor | null}} props the file that is open */
function NewFile({ open, editor }) {
  const may = useCommand("model/create");
  const [asks, setAsks] = useState(false);
  const name = useRef("");
  /** @type {Ref} */
  const field = useRef(null);
  useEffect(() => {
    if (!asks || open !== name.current) return;
    setAsks(false);
    editor?.view.focus();
  }, [open]);
  useEffect(() => {
    if (asks) field.current.focus();
  }, [asks]);
  if (!may) return null;
  if (!asks)
    return html`<div class="new-file"><button class="flat" onClick=${() => setAsks(true)}>
      New file…</button></div>`;
  const create = (/** @type {Event} */ event) => {
    event.preventDefault();
    name.current = /** @type {HTMLInputElement} */ (field.current).value.trim();
    act("model/create", [name.current]);
  };
  return html`<form class="new-file" onSubmit=${create}>
    <input class="field" ref=${field} required maxlength="60" spellcheck=${false}
      autocomplete="off" aria-label="Name of the new file" placeholder="launch/robot.launch.py" />
    <button type="submit">Create</button>
    <button type="button" onClick=${() => setAsks(false)}>Cancel</button></form>`;
}

/** @param {{editor: Editor | null, content: any}} props */
function Buttons({ editor, content }) {
  const saves = useCommand("model/save");
  const reverts = useCommand("model/revert");
  const off = !content?.changed;
  return html`<div class="buttons">
    ${saves && html`<button disabled=${off} onClick=${() => editor?.save()}>Save</button>`}
    <button disabled=${!content} onClick=${() => editor?.download()}
      title="Keep the text as a file of this computer">Download</button>
    ${
      reverts &&
      html`<button disabled=${off} title="Leave out all that is not saved; Ctrl+Z takes it back"
        onClick=${() => editor?.ask("model/revert", [content.file])}>Revert</button>`
    }
    <span class="beside">${content?.changed ? "Not saved" : ""}</span>
  </div>`;
}

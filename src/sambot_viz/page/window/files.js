// @ts-check
/* The .rviz file: its name, saving and opening it, and pictures of the view. */

import { html, useEffect } from "../vendor/preact.js";
import { act, mayChange, rows } from "../wire/channel.js";
import { show } from "../dialogs/dialog.js";
import { ExportPage } from "../dialogs/export_page.js";
import { OpenAgain, OpenConfig, OpenRecording } from "../dialogs/open.js";
import { SaveAs } from "../dialogs/save_as.js";
import { SaveImage } from "../dialogs/save_image.js";
import { tell } from "./notices.js";
import { Cell, folds, selected, unfolded, useData } from "../state.js";

/**
 * @typedef {{name?: string, own?: boolean, modified?: boolean, private?: boolean, folder?: string}}
 *   FileState
 */

/** @returns {FileState} */
const state = () => rows.data("file/state") || {};

/** Whether the server's disk may be used: a visitor with a session of their own only downloads. */
export const hasDisk = () => rows.knows("file/save");

/** Take what is being typed: it is accepted as if the field were left. */
export function takeTyped() {
  const field = document.activeElement;
  if (!(field instanceof HTMLInputElement)) return;
  field.blur();
  field.focus();
}

const sayNoDisk = () =>
  tell("This config is private: File > Download Config saves it on your computer", "info");

export function save() {
  if (!hasDisk()) return sayNoDisk();
  if (!mayChange()) return undefined;
  takeTyped();
  return state().own ? act("file/save", [unfolded()]) : show(SaveAs);
}
export function saveAs() {
  if (!hasDisk()) return sayNoDisk();
  if (!mayChange()) return undefined;
  takeTyped();
  return show(SaveAs);
}
export function open() {
  if (hasDisk() && mayChange()) {
    takeTyped();
    show(OpenConfig);
  }
}
/** Whether another recording may take the place of one that is shown. */
export const hasRecordings = () => rows.knows("recording/open");

export function openRecording() {
  if (hasRecordings() && mayChange()) {
    takeTyped();
    show(OpenRecording);
  }
}
/** How many configs are kept in File > Recent. */
const RECENT = 10;
/** @typedef {{folder: string, name: string}} Recent */
/** The configs that this browser has had, the newest first. @type {Cell<Recent[]>} */
const recent = new Cell(/** @type {Recent[]} */ ([]), "recent");

/** The other configs of this folder that this browser has had, the newest first.
 * @returns {string[]} */
export function recentNames() {
  const { folder, name } = state();
  const here = recent.value.filter((/** @type {Recent} */ one) => one.folder === folder);
  return here
    .map((/** @type {Recent} */ one) => one.name)
    .filter((/** @type {string} */ one) => one !== name);
}

/** Note the config that is shown now as the newest. */
function noteRecent() {
  const { folder, name, own } = state();
  if (!folder || !name || !own) return;
  const [newest] = recent.value;
  if (newest?.folder === folder && newest.name === name) return;
  const others = recent.value.filter(
    (/** @type {Recent} */ one) => one.folder !== folder || one.name !== name,
  );
  recent.set([{ folder, name }, ...others].slice(0, RECENT));
}

/** Open one of them. @param {string} name */
export function openAgain(name) {
  if (!hasDisk() || !mayChange()) return;
  takeTyped();
  show(({ close }) => html`<${OpenAgain} name=${name} close=${close} />`);
}
export function download() {
  takeTyped();
  act("file/download");
}
export function saveImage() {
  show(SaveImage);
}
export function exportPage() {
  show(ExportPage);
}

/** A name of more characters may be cut before its last ones. */
const LONG = 24,
  TAIL = 14;

/** The name of the file, with a star after an edit; also the title of the page. */
export function FileName() {
  const state = useData("file/state");
  const { name, own, modified } = state || {};
  // Before the server has said anything, there may be a file.
  const known = name || (state ? "no file yet" : "");
  const shown = known + (modified ? "*" : "");
  useEffect(() => {
    document.title = shown ? `${shown} - sambot-viz` : "sambot-viz";
  }, [shown]);
  // Of a long name the middle is left out: its end has the star, or room for it.
  const tail = known.length > LONG ? known.slice(-TAIL) : "";
  const star = html`<span class=${modified ? "star" : "star none"}>*</span>`;
  const where = own
    ? ""
    : name
      ? "This config comes with the program; saving asks for a new name."
      : "";
  const title = known && `${known}: ${modified ? "unsaved changes." : "no changes."} ${where}`;
  return html`<span class="file-name" title=${title}><bdi>
    ${known.slice(0, known.length - tail.length)}${!tail && star}</bdi>${
      tail && html`<bdi>${tail}${star}</bdi>`
    }</span>`;
}

/** Save the text of the model, where only that is not saved; whether it was so. */
function saveText() {
  const text = rows.data("model/text");
  if (!text?.changed || state().modified || !rows.can("model/save")) return false;
  act("model/save", [text.file]);
  return true;
}

/** The keys of the file menu, which also act while a text is typed. */
function keys() {
  addEventListener(
    "keydown",
    (event) => {
      if (!(event.ctrlKey || event.metaKey) || event.altKey || event.key.toLowerCase() !== "s")
        return;
      // In the text of the model it saves that.
      if (event.target instanceof Element && event.target.closest(".model .text")) return;
      // The browser would save the page.
      event.preventDefault();
      event.stopPropagation();
      if (event.repeat || document.querySelector("dialog[open]")) return;
      if (event.shiftKey) saveAs();
      else if (!saveText()) save();
    },
    true,
  );
}

/** Follow the file from now on. */
export function followFile() {
  keys();
  // The config of a visitor goes with the page; that of everyone stays on the server.
  addEventListener("beforeunload", (event) => {
    if (state().private && state().modified) event.preventDefault();
  });
  // A document that was opened or read again is unfolded as its file says, and none of
  // its rows is selected.
  const current = () => ({
    session: rows.data("names/session")?.id,
    document: rows.data("names/document"),
  });
  let shown = current();
  const look = () => {
    const now = current();
    // A program that was started again counts from 0.
    if (
      shown.document !== undefined &&
      now.session === shown.session &&
      now.document !== shown.document
    ) {
      folds.set({});
      selected.set({ ...selected.value, displays: "", views: "" });
    }
    shown = now;
  };
  for (const id of ["names/session", "names/document"]) rows.listen(id, look);
  rows.listen("file/state", noteRecent);
}

// @ts-check
/* The properties and arguments of the model as sliders, above its text. */

import { html, useEffect, useMemo } from "../vendor/preact.js";
import { act, rows } from "../wire/channel.js";
import { Cell, useCommand, useData, useRow } from "../state.js";
import { Tree } from "../tree/tree.js";
import { longestName } from "./joints.js";

/** @typedef {import("../wire/rows.js").Row} Row */

/** Whether they are unfolded; a phone has room for one of the two, until somebody chooses.
 * @type {Cell<boolean>} */
const unfolded = new Cell(!matchMedia("(max-width: 600px)").matches, "numbers");

/** Show where a number is written. @param {Row} row */
function find({ id }) {
  act("model/number", [id]);
  return true;
}

/** @param {Row} row */
const menu = (row) => [{ label: "Go to its line", act: () => find(row) }];

/** @param {{write: (() => void) | undefined}} props writes what was moved into the text */
export function ModelNumbers({ write }) {
  const open = unfolded.use();
  const shown = useData("numbers/shown");
  // They are sent only while somebody can see them.
  useEffect(() => {
    if (shown === false) act("numbers/show", [true]);
  }, [shown]);
  useEffect(() => () => act("numbers/show", [false]), []);
  useRow("panel:numbers");
  const ids = rows.panels.get("numbers") || [];
  // Those that are moved are bold.
  const names = useMemo(() => 1.1 * longestName(ids), [ids]);
  const count = useData("numbers/count");
  if (!count) return null;
  return html`<div class="numbers" style=${`--names: ${names}px`}>
    <button class="flat fold" aria-expanded=${String(open)} onClick=${() => unfolded.set(!open)}>
      <span class=${`twist ${open ? "open" : ""}`} />Properties and arguments${" "}
      <span class="soft">(${count})</span></button>
    ${
      open &&
      html`<div class="list"><${Tree} panel="numbers" label="Properties and arguments"
        split=${false} menu=${menu} onDouble=${find} /></div>
      <${Buttons} write=${write} />`
    }
  </div>`;
}

/** @param {{write: (() => void) | undefined}} props */
function Buttons({ write }) {
  const moved = useData("numbers/moved") || 0;
  const writable = useData("numbers/writable") || 0;
  const may = useCommand("model/write");
  if (!may) return null;
  const said = moved && `${moved} moved, not in the text`;
  return html`<div class="buttons">
    <button class="needs-control" disabled=${!writable || !write} onClick=${write}
      title="Put the moved numbers into their lines; Undo in the editor takes them back">Write into the text</button>
    <button class="needs-control" disabled=${!moved} onClick=${() => act("numbers/reset")}
      title="Take all numbers back to those of the text">Reset</button>
    <span class="beside" role="status">${said || ""}</span>
  </div>`;
}

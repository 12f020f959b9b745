// @ts-check
/* The Frames panel: where one frame is in another, and static transforms to add. */

import { html, useEffect, useRef, useState } from "../vendor/preact.js";
import { act, rows, send } from "../wire/channel.js";
import { Combo } from "../cells/combo.js";
import { refusals, refuse, sayRefused } from "../window/notices.js";
import { parseNumber } from "../cells/numbers.js";
import { workedOut } from "../cells/pasted.js";
import { degrees, fold, folds, isOpen, selected, useData, useRow } from "../state.js";
import { NotFound, Search } from "../tree/search.js";
import { Tree } from "../tree/tree.js";
import { ValidationMessage } from "../cells/validation_message.js";

/** @typedef {import("../wire/rows.js").Row} Row */

/** @param {Row} row */
const isFrame = (row) => row.icon === "frame";

export function FramesPanel() {
  const shown = useData("frames/shown");
  // The answer follows motions only while somebody can see it.
  useEffect(() => {
    if (shown === false) act("frames/show", [true]);
  }, [shown]);
  useEffect(() => () => act("frames/show", [false]), []);
  const chosen = useRow(selected.use().frames || "none");
  const of = chosen?.static
    ? chosen
    : rows.get(chosen?.in || "")?.static
      ? rows.get(chosen?.in || "")
      : undefined;
  const remove = () => of && act("frames/remove", [of.id]);
  /** @param {KeyboardEvent} event @param {Row} row */
  const key = (event, row) => {
    if (event.key === "Enter") return ask(row);
    if (event.key !== "Delete" || !row.static) return false;
    remove();
    return true;
  };
  /** Where a frame of the list is. @param {Row} row */
  const ask = (row) => {
    if (!isFrame(row) || row.static) return false;
    send("frames/to", row.name);
    return true;
  };
  return html`<div class="frames">
    <div class="buttons"><${Search} panel="frames" what="frames" finds=${isFrame} /></div>
    <${NotFound} panel="frames" finds=${isFrame} />
    <${Tree} panel="frames" label="Frames" finds=${isFrame} onKey=${key} onDouble=${ask} />
    <${Add}>
      <button disabled=${!of} title="Remove the selected static transform (Delete)"
        onClick=${remove}>Remove</button>
    </${Add}>
  </div>`;
}

const LENGTHS = ["x", "y", "z"],
  ANGLES = ["roll", "pitch", "yaw"];

/** Fields for a new static transform, and a place to paste one. @param {{children?: any}} props */
function Add({ children }) {
  folds.use();
  const open = isOpen("frames/form");
  return html`<div class="buttons">
      <button aria-expanded=${String(open)}
        onClick=${() => fold("frames/form", !open)}>Add static transform …</button>${children}
    </div>
    ${open && html`<${Form} />`}`;
}

function Form() {
  const inDegrees = degrees.use();
  useData("names/frames");
  useRow("frames/from");
  useRow("frames/add");
  useRow("frames/paste");
  const why = refusals.get("frames/add") || refusals.get("frames/paste");
  /** @type {Ref<HTMLFormElement>} */
  const form = useRef(null);
  const [parent, setParent] = useState(/** @type {string | null} */ (null));
  const within = parent ?? rows.value("frames/from") ?? "";
  const angle = inDegrees ? "°" : "rad";
  // What was added is cleared: its name is not wanted again.
  const wanted = useRef(-1);
  useRow("panel:frames");
  const count = rows.children("frames/static").filter((id) => rows.get(id)?.static).length;
  /** @param {string} name */
  const field = (name) =>
    /** @type {HTMLInputElement} */ (form.current.querySelector(`[name=${name}]`));
  useEffect(() => {
    if (wanted.current < 0 || count <= wanted.current) return;
    wanted.current = -1;
    for (const name of ["child", "pasted"]) field(name).value = "";
  }, [count]);
  /** @param {string} name */
  const typed = (name) => field(name).value;
  const begin = () => refuse("frames/add");
  /** @param {Event} event */
  const add = (event) => {
    event.preventDefault();
    begin();
    wanted.current = count;
    if (typed("pasted").trim()) return act("frames/paste", [workedOut(typed("pasted"))]);
    /** @type {number[]} */
    const numbers = [];
    for (const name of [...LENGTHS, ...ANGLES]) {
      const read = parseNumber(typed(name) || "0", LENGTHS.includes(name) ? "m" : angle);
      if ("error" in read) return sayRefused("frames/add", `${name}: ${read.error}`);
      numbers.push(read.value);
    }
    return act("frames/add", [...numbers, within, typed("child")]);
  };
  /** @param {string} name @param {string} unit */
  const number = (
    name,
    unit,
  ) => html`<label><span>${name}</span> <input name=${name} autocomplete="off"
    placeholder=${`0 ${unit}`} title=${`${name}, in ${unit} or with a unit behind it`} /></label>`;
  return html`<form class="fields" ref=${form} onSubmit=${add} onInput=${begin}
    aria-label="Static transform">
    ${LENGTHS.map((name) => number(name, "m"))}
    ${ANGLES.map((name) => number(name, angle))}
    <label class="wide"><span>Parent</span> <${Combo} label="Parent" value=${within}
      options=${rows.data("names/frames") || []} tab=${0} accept=${setParent} /></label>
    <label class="wide"><span>Child</span> <input name="child" autocomplete="off"
      spellcheck=${false} placeholder="base_laser" /></label>
    <label class="wide"><span>Or paste</span> <input name="pasted" autocomplete="off"
      spellcheck=${false} aria-label="Arguments of static_transform_publisher"
      placeholder="x y z yaw pitch roll parent child"
        title="The arguments of static_transform_publisher, a command or a line of a launch file" />
          </label>
    <button class="wide" type="submit">Add</button>
    <p class="wide">You can enter pi/2, 90deg or 5cm; empty means 0.</p>
    ${why && html`<${ValidationMessage} text=${why} />`}
  </form>`;
}

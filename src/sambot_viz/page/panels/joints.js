// @ts-check
/* The Joints panel: a slider for each joint, and what can be done with all of them. */

import { html, useLayoutEffect, useMemo, useRef, useState } from "../vendor/preact.js";
import { act, rows } from "../wire/channel.js";
import { CutText } from "../window/cut_text.js";
import { Icon } from "../window/icons.js";
import { refusals } from "../window/notices.js";
import { useFollowed } from "../cells/followed.js";
import { NumberCell } from "../cells/number_cells.js";
import { Popup } from "../window/popup.js";
import { Cell, degrees, fold, folds, isOpen, selected, useData, useRow } from "../state.js";
import { NotFound, Search } from "../tree/search.js";
import { Tree } from "../tree/tree.js";
import { formula, limits, NARROW } from "../cells/units.js";
import { ValidationMessage } from "../cells/validation_message.js";
import { hovered, pointing, useGlowEnd } from "./pointed_joint.js";
import { Poses } from "./poses.js";

/** @typedef {import("../wire/rows.js").Row} Row */

const SEARCH_FROM = 12;
/** Left and right of a name, and what is more when there are groups [px]. */
const AROUND_NAME = 10;
const INDENT = 14;
/** What a finger needs beside a name: a slider that is long enough, and the number [px]. */
const FOR_A_FINGER = 230;
const TURN_BUTTON = 38;

/** How the values of the joints can be copied. @type {Record<string, string>} */
const FORMS = {
  yaml: "As yaml (sensor_msgs/JointState)",
  command: "As a ros2 topic pub command",
  launch: "For a launch file (joint_state_publisher)",
  arguments: "As --joint arguments",
};
/** The form that was copied last. @type {Cell<string>} */
const form = new Cell("yaml", "copied");

/** @param {string} id */
const rowOf = (id) => /** @type {Row} */ (rows.get(id));
/** @param {Row} row */
const isSlider = (row) => row.kind === "slider";

export function JointsPanel() {
  useRow("panel:joints");
  /** @type {Ref} */
  const panel = useRef(null);
  const ids = rows.panels.get("joints") || [];
  const grouped = ids.some((id) => rows.get(id)?.kind === "group");
  const names = useMemo(() => longestName(ids) + (grouped ? INDENT : 0), [ids]);
  const width = useWidth(panel);
  useGlowEnd();
  const free = !useFollowed();
  if (rows.get("joints/none")) return html`<${Tree} panel="joints" label="Joints" />`;
  const many = ids.filter((id) => isSlider(rowOf(id))).length > SEARCH_FROM;
  const wheels = Boolean(rows.get("joints/rate"));
  const stacked =
    matchMedia("(pointer: coarse)").matches &&
    names + FOR_A_FINGER + (wheels ? TURN_BUTTON : 0) > width;
  const look = `joints${wheels ? " wheels" : ""}${grouped ? " grouped" : ""}${stacked ? " stacked" : ""}`;
  return html`<div class=${look} ref=${panel} style=${`--names: ${names}px`}>
    <div class="buttons" role="toolbar" aria-label="All joints">
      <button class="needs-control" disabled=${!free} onClick=${() => act("joints/center")}
        title="Move all joints to their start positions">Center</button>
      <button class="needs-control" disabled=${!free} onClick=${() => act("joints/randomize")}
        title="Move all joints to random positions within their limits">Randomize</button>
      <${Copy} />
      <${Poses} />
    </div>
    <div class="buttons">
      <${Degrees} />
      ${wheels && html`<${TurnRate} />`}
      ${
        many && html`<${Search} panel="joints" what="joints" finds=${isSlider} enter="input.num" />`
      }
      <${FoldAll} />
    </div>
    <div class="list" ...${pointing}>
      <${NotFound} panel="joints" finds=${isSlider} />
      <${Tree} panel="joints" label="Joints" finds=${isSlider} />
    </div>
    <${OverLimit} />
    <${Out} />
    <${Help} />
  </div>`;
}

/** How wide the longest name of a slider is [px]. @param {string[]} ids */
export function longestName(ids) {
  const brush = document.createElement("canvas").getContext("2d");
  if (!brush) return 130;
  brush.font = getComputedStyle(document.getElementById("sambot") || document.body).font;
  const widths = ids
    .map((id) => rows.get(id))
    .filter((row) => row?.kind === "slider")
    .map((row) => brush.measureText(row?.name || "").width);
  return Math.ceil(Math.max(60, ...widths)) + AROUND_NAME;
}

/** The width of an element, in a component [px]. @param {{current: any}} element */
function useWidth(element) {
  const [width, setWidth] = useState(Infinity);
  useLayoutEffect(() => {
    if (!element.current) return undefined;
    const observer = new ResizeObserver(() => setWidth(element.current?.clientWidth ?? Infinity));
    observer.observe(element.current);
    return () => observer.disconnect();
  }, [element.current]);
  return width;
}

/** One click copies, as the last time; the list offers the other forms. */
function Copy() {
  const last = form.use();
  /** @param {string} name */
  const copy = (name) => {
    form.set(name);
    act("joints/copy", [name]);
  };
  return html`<span class="split">
    <button title=${`Copy the joint values: ${FORMS[last]}`}
      onClick=${() => copy(last)}>Copy</button>
    <${Popup} name="Copy as" role="menu" label=${html`<${Icon} name="down" />`}>${(
      /** @type {() => void} */ close,
    ) =>
      Object.entries(FORMS).map(
        ([name, label]) => html`<button role="menuitem" key=${name}
        onClick=${() => {
          copy(name);
          close();
        }}>${label}</button>`,
      )}<//>
  </span>`;
}

function Degrees() {
  const inDegrees = degrees.use();
  return html`<button aria-pressed=${String(inDegrees)} onClick=${() => degrees.set(!inDegrees)}
    title=${inDegrees ? "Angles are in degrees; click for radians" : "Angles are in radians; click for degrees"}>Degrees</button>`;
}

function TurnRate() {
  const row = useRow("joints/rate");
  if (!row) return null;
  const why = refusals.get(row.id);
  return html`<label class="rate" title=${row.help}>Turn rate <${NumberCell} row=${row} tab=${0}
    room=${NARROW} /></label>
    ${why && html`<${ValidationMessage} text=${why} />`}`;
}

/** Folds all groups, or unfolds them. */
function FoldAll() {
  folds.use();
  const groups = rows.children("panel:joints").filter((id) => rows.get(id)?.kind === "group");
  if (groups.length < 3) return null;
  const open = groups.some(isOpen);
  const label = open ? "Collapse all groups" : "Expand all groups";
  return html`<button class="flat" title=${label} aria-label=${label}
    onClick=${() => groups.forEach((id) => fold(id, !open))}>
      <${Icon} name=${open ? "foldAll" : "unfoldAll"} /></button>`;
}

/** Which joints are over a limit; the page cannot set them so, but a file or a program can. */
function OverLimit() {
  const over = useData("joints/over") || [];
  if (!over.length) return null;
  const named = over.slice(0, 3).join(", ");
  const more = over.length > 3 ? ` and ${over.length - 3} more` : "";
  return html`<p class="over" role="status"><${Icon} name="warn"
    /> Over ${over.length === 1 ? "its limit" : "their limits"}: ${named}${more}</p>`;
}

/** Who gets the joints, or why nobody does: below the sliders, which stay where they are. */
function Out() {
  const said = useData("joints/out");
  return said ? html`<${CutText} is="out" role="status" text=${said} />` : null;
}

/** What is known of the joint under the mouse, or of the selected one. */
function Help() {
  degrees.use();
  const id = hovered.use() || selected.use().joints || "";
  const row = useRow(id || "none");
  const followed = useFollowed();
  return html`<div class="help">${
    row?.kind === "slider" &&
    html`<b>${row.name}</b>${followed && html`<br />${followed}`}<br />
    ${row.help}<br />
    ${row.follows ? `position ${formula(row)}; ` : ""}
      ${row.wheel ? `no limits (shown from ${degrees.value ? "−180° to 180°" : "−π to π"})` : row.min === undefined ? "no limits" : `limits ${limits(row)}`}`
  }</div>`;
}

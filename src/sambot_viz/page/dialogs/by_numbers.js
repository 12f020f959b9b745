// @ts-check
/* The pose of a tool such as 2D Goal Pose by numbers: its arrow is shown until it is sent. */

import { html, useEffect, useRef, useState } from "../vendor/preact.js";
import { act, newGesture, rows, send } from "../wire/channel.js";
import { parseNumber, writtenNumber } from "../cells/numbers.js";
import { shownUnit } from "../cells/units.js";
import { useData } from "../state.js";
import { isTyping } from "../window/keys.js";
import { focusView } from "../view/pointer.js";
import { Dialog, leaveFor, show } from "./dialog.js";

/** The tool that is current, if it sends poses. @returns {{name: string} | undefined} */
const poseTool = () =>
  (rows.data("tools/list") || []).find((/** @type {any} */ tool) => tool.current && tool.poses);

/** A plain number is radians: 90 is seen not to be a right angle. @param {number} angle [rad] */
export const inDegrees = (angle) => {
  const { factor, unit } = shownUnit(/** @type {any} */ ({ unit: "rad" }), true);
  return `= ${writtenNumber(angle * factor, 1)}${unit}`;
};

/** What was typed last, for the next pose of each tool. @type {Record<string, string[]>} */
const last = {};

/** @param {{close: () => void}} props */
function ByNumbers({ close }) {
  const name = useRef(poseTool()?.name).current;
  const frame = useData("tools/frame");
  const refusal = useData("tools/pose_refusal");
  const [typed, setTyped] = useState(last[name ?? ""] || ["0", "0", "0"]);
  const gesture = useRef(newGesture()).current;
  const sent = useRef(false);
  const read = typed.map((text, n) => parseNumber(text, n === 2 ? "rad" : "m"));
  const wrong = read.map((one) => ("error" in one ? one.error : ""));
  const values = read.map((one) => ("value" in one ? one.value : 0));
  const isWhole = wrong.every((why) => !why);
  useEffect(() => {
    if (isWhole) send("tools/preview", values, gesture);
  }, [typed.join(" ")]);
  useEffect(
    () => () => {
      if (!sent.current) act("tools/right_click");
    },
    [],
  );
  const submit = () => {
    if (!isWhole || refusal) return;
    last[name ?? ""] = typed;
    sent.current = true;
    leaveFor(focusView);
    act("tools/send", values);
    close();
  };
  /** @param {number} n @param {string} label @param {string} unit @param {string} [also] */
  const field = (n, label, unit, also) => html`<label class="line"><span class="of">${label}</span>
    <input type="text" inputmode="decimal" aria-label=${label} value=${typed[n]}
      aria-invalid=${wrong[n] ? "true" : undefined} data-first=${n === 0 ? "" : undefined}
      onFocus=${(/** @type {Change} */ e) => e.target.select()}
      onInput=${(/** @type {Change} */ e) => setTyped(typed.with(n, e.target.value))} />
    <span class="unit">${unit}</span>${also !== undefined && html`<span class="also">${also}</span>`}</label>`;
  return html`<${Dialog} title=${`${name} by numbers`} close=${close} submit=${submit} look="beside">
    <p>In ${frame}. The arrow in the view shows it; nothing is sent before you send it.</p>
    ${field(0, "x", "m")} ${field(1, "y", "m")} ${field(2, "Heading", "rad", wrong[2] ? "" : inDegrees(values[2]))}
    <p role="status">${wrong.find(Boolean) || (refusal && `${refusal}.`) || ""}</p>
    <div class="buttons end">
      <button type="submit" class="main" disabled=${!isWhole || Boolean(refusal)}>Send</button>
      <button type="button" onClick=${close}>Cancel</button>
    </div>
  </${Dialog}>`;
}

/** Beside the hint of a tool that sends poses. */
export function ByNumbersButton() {
  useData("tools/list");
  if (!poseTool()) return null;
  return html`<button class="needs-control" title="Type x, y and heading (Enter)"
    aria-label="By numbers…" onClick=${() => show(ByNumbers)}><span class="brief">x, y…</span
      ><span class="words">By numbers…</span></button>`;
}

/** After a refusal that the frame map would not have had. */
export function UseMapButton() {
  if (!useData("tools/wants_map")) return null;
  return html`<button class="needs-control" title="Make map the fixed frame; Undo puts it back"
    onClick=${() => act("tools/use_map")}>Use map</button>`;
}

/** Enter opens it, where it has no other use. */
export function followByNumbers() {
  addEventListener("keydown", (event) => {
    const { target } = event;
    const isTaken =
      target instanceof Element && (isTyping(target) || target.matches("button, [role=row]"));
    if (event.key !== "Enter" || event.defaultPrevented || isTaken || !poseTool()) return;
    event.preventDefault();
    show(ByNumbers);
  });
}

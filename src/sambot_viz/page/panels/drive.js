// @ts-check
/* The Drive panel: buttons to hold, speeds, and where the robot is. */

import { html, useEffect, useRef } from "../vendor/preact.js";
import { act, CUT, EDITED, edited, rows } from "../wire/channel.js";
import { Icon } from "../window/icons.js";
import { formatNumber } from "../cells/numbers.js";
import { Cell, degrees, useData, useRow } from "../state.js";
import { CutText } from "../window/cut_text.js";
import { Tree } from "../tree/tree.js";
import { shownUnit } from "../cells/units.js";

/** How often a page that drives says so: without that, the robot stops [ms]. */
const PERIOD = 250;
/** A robot that rests for so many periods is not driven any longer: a slow answer takes a few. */
const AT_REST = 12;
/**
 * What the buttons do: m/s forwards and rad/s to the left.
 * @type {Record<string, [string, number, number]>}
 */
const WAYS = {
  forwards: ["Forwards", 0.5, 0],
  left: ["Left", 0, 1],
  right: ["Right", 0, -1],
  back: ["Back", -0.5, 0],
};

/** The ways that are held now, with several fingers even. @type {Set<string>} */
const held = new Set();
/** Whether this page keeps up a speed that a key or a slider of it has set. */
let keeps = false,
  rests = 0,
  timer = 0;

/** What sets a speed that stays. */
const SPEEDS = new Set(["drive/press", "drive/linear", "drive/angular"]);

function beat() {
  const moves = rows.value("drive/linear") || rows.value("drive/angular");
  rests = moves ? 0 : rests + 1;
  if (rests > AT_REST) keeps = false;
  if (held.size) return drive();
  if (keeps) return act("drive/keep");
  clearInterval(timer);
  timer = 0;
}

function startBeats() {
  rests = 0;
  if (!timer) timer = setInterval(beat, PERIOD);
}

/** The hand is gone: whoever comes back has to drive again. */
function leave() {
  keeps = false;
  for (const name of [...held]) letGo(name);
}

/** Say that this page drives, as long as it does and can be seen. */
export function followDriving() {
  rows.listen(EDITED, () => {
    if (!SPEEDS.has(edited())) return;
    keeps = true;
    startBeats();
  });
  rows.listen(CUT, leave);
  addEventListener("visibilitychange", () => document.hidden && leave());
}

function drive() {
  const ways = [...held].map((name) => WAYS[name]);
  act(
    "drive/hold",
    [1, 2].map((part) => ways.reduce((sum, way) => sum + Number(way[part]), 0)),
  );
}

/** @param {string} name */
function hold(name) {
  if (held.has(name)) return;
  held.add(name);
  keeps = false;
  drive();
  startBeats();
}

/** @param {string} name */
function letGo(name) {
  if (!held.delete(name)) return;
  if (held.size) return drive();
  act("drive/stop");
}

/** Whether the panel is there, with its own Stop. @type {Cell<boolean>} */
const there = new Cell(false);

export function DrivePanel() {
  useEffect(() => {
    there.set(true);
    return () => there.set(false);
  }, []);
  // A click beside its buttons gives it the keys too.
  return html`<div class="drive" tabindex="-1">
    <div class="pad" role="group" aria-label="Drive">
      ${Object.entries(WAYS).map(
        ([name, [label]]) => html`<${HoldButton} key=${name} name=${name} label=${label}
          hold=${hold} letGo=${letGo} />`,
      )}
      <${Stop} />
      <button class="home needs-control"
        title="Move the robot back to the start, and reset wheels, path, fixed frame and view"
          onClick=${() => act("drive/reset")}>Back to start</button>
      <p class="keys">Hold a button. Each press of 8 2 4 6 adds speed; 5 stops</p>
    </div>
    <${Tree} panel="drive" label="Drive" split=${false} />
  </div>`;
}

function Stop() {
  return html`<button class="halt" aria-keyshortcuts="5" title="Stop (5)"
    onClick=${() => act("drive/stop")}><${Icon} name="stop" /> Stop</button>`;
}

/** Drives while it is held, by a mouse, a finger, Space or Enter.
 * @param {{name: string, label: string, hold: (name: string) => void,
 *   letGo: (name: string) => void}} props */
export function HoldButton({ name, label, hold, letGo }) {
  const start = () => hold(name);
  const end = () => letGo(name);
  useEffect(() => {
    // A hand that goes to another window may let go there.
    addEventListener("blur", end);
    return () => {
      removeEventListener("blur", end);
      end();
    };
  }, []);
  /** @type {Ref} */
  const element = useRef(null);
  /** @param {Key} event */
  const key = (event) => {
    if (event.key !== " " && event.key !== "Enter") return;
    event.preventDefault();
    if (event.type === "keyup") end();
    else start();
  };
  return html`<button class=${`way go-${name}`} ref=${element} aria-label=${label}
    title=${`${label}, while it is held`}
    onPointerDown=${(/** @type {Press} */ e) => {
      if (e.button === 0) {
        element.current.setPointerCapture(e.pointerId);
        start();
      }
    }}
    onPointerUp=${end} onPointerCancel=${end} onLostPointerCapture=${end} onBlur=${end}
    onKeyDown=${key} onKeyUp=${key}
    onContextMenu=${(/** @type {Press} */ e) => e.preventDefault()}><${Icon} name=${name} />
      </button>`;
}

const ALONE = "The robot has stopped: the page that drove it was closed or hidden";

/** While the robot drives: how fast, and Stop, unless the panel has it; later, why it stopped. */
export function Driving() {
  degrees.use();
  const stops = !there.use();
  const linear = useRow("drive/linear");
  const angular = useRow("drive/angular");
  const alone = useData("drive/alone");
  const moving = [linear, angular].filter((row) => row?.value);
  if (!linear) return null;
  if (!moving.length)
    return alone ? html`<${CutText} is="stopped" role="status" text=${ALONE} />` : null;
  const speeds = moving.map((row) => {
    const { factor, unit } = shownUnit(/** @type {any} */ (row));
    return `${formatNumber(row?.value * factor, 2)} ${unit}`;
  });
  return html`<span class="driving"><span class="speeds">Driving ${speeds.join(", ")}</span>
    ${stops && html`<${Stop} />`}</span>`;
}

// @ts-check
/* Drives a live robot, as long as a key, a button or the stick is held. The page says so ten times
 * a second; what stops the robot when it does not is in the server (dead_mans_switch.py). */

import { html, useEffect, useRef, useState } from "../vendor/preact.js";
import { Tree } from "../tree/tree.js";
import { act, CUT, rows } from "../wire/channel.js";
import { Icon } from "../window/icons.js";
import { isTyping } from "../window/keys.js";
import { CutText } from "../window/cut_text.js";
import { useData } from "../state.js";
import { HoldButton } from "./drive.js";

/** How long it is said why the robot was stopped [ms]. */
const SAID = 10000;
/** How often a page that drives says so [ms]. */
const PERIOD = 100;
/** What is held and where to: parts of the highest speed, forwards and to the left.
 * @type {Record<string, [string, number, number]>} */
const WAYS = {
  forwards: ["Forwards", 1, 0],
  left: ["Left", 0, 1],
  right: ["Right", 0, -1],
  back: ["Back", -1, 0],
};
/** The keys of a number pad. @type {Record<string, string>} */
const KEYS = { 8: "forwards", 4: "left", 6: "right", 2: "back" };
const STICK = "stick";
/** Where digits drive it. */
const HERE = ".for-live, [data-tab=live]";

/** @type {Map<string, [number, number]>} */
const held = new Map();
let timer = 0;
/** The number of the press: one that has ended does not count again. */
let press = 0;
let isMine = false;

function say() {
  let [forwards, left] = [0, 0];
  for (const [x, y] of held.values()) [forwards, left] = [forwards + x, left + y];
  const part = (/** @type {number} */ value) => Math.max(-1, Math.min(1, value));
  act("live/hold", [press, part(forwards), part(left)]);
}

/** @param {string} name @param {[number, number]} way */
function start(name, way) {
  const begins = !held.size;
  held.set(name, way);
  if (begins) {
    press += 1;
    timer = window.setInterval(say, PERIOD);
    say();
  } else if (name !== STICK) say();
}

/** @param {string} name */
function letGo(name) {
  if (!held.delete(name)) return;
  if (held.size) say();
  else end(true);
}

/** @param {boolean} tells whether the server is told */
function end(tells) {
  held.clear();
  clearInterval(timer);
  if (tells) act("live/release", [press]);
}

/** Whether this page drives the robot now. */
export const drivesRobot = () => isMine || held.size > 0;

/** @param {KeyboardEvent} event */
function key(event) {
  const name = KEYS[/** @type {any} */ (event.key)];
  if (!name) return;
  if (event.type === "keyup") return letGo(name);
  if (event.defaultPrevented || event.ctrlKey || event.altKey || event.metaKey) return;
  const { target } = event;
  // While the panel is shown they drive from the view too, where a click has led the keys.
  const inView = target === document.body || (target instanceof Element && target.closest("#root"));
  const isHere =
    (target instanceof Element && target.closest(HERE)) ||
    (inView && document.querySelector(".pad.live"));
  if (!isHere || isTyping(target) || rows.data("live/state")?.refusal) return;
  event.preventDefault();
  if (!event.repeat) start(name, way(name));
}

/** Let go when the hand cannot be there any more, or the server has stopped the robot. */
export function followLiveDriving() {
  const leave = () => held.size && end(true);
  // Before the keys of the window.
  addEventListener("keydown", key, true);
  addEventListener("keyup", key, true);
  addEventListener("blur", leave);
  addEventListener("pagehide", leave);
  addEventListener("visibilitychange", () => document.hidden && leave());
  rows.listen(CUT, () => end(false));
  // What is refused is not asked again until the next press.
  rows.listen("notice", () => rows.data("notice")?.row === "live/hold" && end(false));
  rows.listen("live/state", () => {
    const driver = rows.data("live/state")?.client;
    const was = isMine;
    isMine = driver != null && driver === rows.data("role/me")?.client;
    if (was && !isMine) end(false);
  });
}

export function LiveDrivePanel() {
  const state = useData("live/state");
  useEffect(() => () => [...held.keys()].forEach(letGo), []);
  if (!state) return null;
  const off = state.refusal;
  return html`<div class="drive for-live" tabindex="-1">
    ${
      off
        ? html`<p class="off">${off[0].toUpperCase() + off.slice(1)}.</p>`
        : html`<div class="pad live needs-control" role="group" aria-label="Drive the robot">
      ${Object.entries(WAYS).map(
        ([name, [label]]) => html`<${HoldButton} key=${name} name=${name} label=${label}
          hold=${() => start(name, way(name))} letGo=${letGo} />`,
      )}
      <${Stick} />
      <p class="keys">The robot moves while you hold a button, the stick, or 8 2 4 6</p>
      <p class="keys">If the connection is lost: ${state.protection}</p>
    </div>`
    }
    <${Tree} panel="live" label="Drive the robot" split=${false} />
  </div>`;
}

/** @param {string} name @returns {[number, number]} */
const way = (name) => [WAYS[name][1], WAYS[name][2]];

/** A stick for mouse and finger: how far it is drawn is how fast. */
function Stick() {
  /** @type {Ref} */
  const element = useRef(null);
  /** @param {number} x @param {number} y parts of the radius, to the right and down */
  const show = (x, y) => {
    element.current.style.setProperty("--x", String(x));
    element.current.style.setProperty("--y", String(y));
  };
  /** @param {PointerEvent} event */
  const draw = (event) => {
    const { left, top, width, height } = element.current.getBoundingClientRect();
    const [x, y] = [
      (2 * (event.clientX - left)) / width - 1,
      (2 * (event.clientY - top)) / height - 1,
    ];
    const far = Math.max(1, Math.hypot(x, y));
    show(x / far, y / far);
    start(STICK, [-y / far, -x / far]);
  };
  const release = () => {
    show(0, 0);
    letGo(STICK);
  };
  const state = useData("live/state");
  // What was ended is let go of: the next press begins in the middle again.
  useEffect(() => {
    if (!held.has(STICK)) show(0, 0);
  }, [state]);
  return html`<div class="stick" ref=${element} title="Draw it to where the robot is to go"
    onPointerDown=${(/** @type {Press} */ e) => {
      if (e.button !== 0 || e.buttons !== 1) return;
      element.current.setPointerCapture(e.pointerId);
      draw(e);
    }}
    onPointerMove=${(/** @type {PointerEvent} */ e) => held.has(STICK) && draw(e)}
    onPointerUp=${release} onPointerCancel=${release} onLostPointerCapture=${release}
    ><span class="knob"></span></div>`;
}

/** STOP for everybody, on every page, wherever something may be sent to a robot. */
export function StopRobot() {
  const state = useData("live/state");
  if (!state || !rows.can("live/stop")) return null;
  return html`<button class="stop-robot" aria-label="STOP" aria-keyshortcuts="Escape Escape"
    title="Stop the robot (Space while you drive; elsewhere Esc twice)"
    onClick=${() => act("live/stop")}><${Icon} name="stop" /> STOP</button>`;
}

/** How far the robot's goal is, and what cancels it. */
export function LiveGoal() {
  const goal = useData("live/goal");
  if (!goal) return null;
  return html`<span class="driving"><${CutText} is="stopped" role="status" text=${`Goal: ${goal}`} />
    <button class="needs-control" title="Cancel all goals of the robot"
      onClick=${() => act("live/cancel")}>Cancel</button></span>`;
}

/** Who drives the robot, or why it was stopped. */
export function LiveDriving() {
  const state = useData("live/state");
  const stops = state?.stops || 0;
  const [old, setOld] = useState(stops);
  useEffect(() => {
    if (stops === old) return undefined;
    const timer = setTimeout(() => setOld(stops), SAID);
    return () => clearTimeout(timer);
  }, [stops]);
  if (!state || (state.client == null && (!state.why || stops === old))) return null;
  const goal = state.goal ? `; its goal goes on: ${state.goal}` : "";
  const isFailed = state.client == null && state.failure;
  const stopped = state.failure || `The robot was stopped: ${state.why}`;
  const text =
    state.client == null ? `${stopped}${goal}` : `${state.name || "Somebody"} drives the robot`;
  return html`<${CutText} is=${isFailed ? "stopped error" : "stopped"}
    role=${isFailed ? "alert" : "status"} text=${text} />`;
}

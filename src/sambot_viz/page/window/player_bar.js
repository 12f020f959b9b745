// @ts-check
/* The player below the view: the time of a recording. While it plays, the page lets its
 * own time go on, and is told once in a while where the recording is. */

import { html, useEffect, useReducer, useRef, useState } from "../vendor/preact.js";
import { useCommand, useData, useRow } from "../state.js";
import { act, newGesture, rows, send } from "../wire/channel.js";
import { CutText } from "./cut_text.js";
import { Icon } from "./icons.js";
import { Popup } from "./popup.js";

const RATES = [0.1, 0.25, 0.5, 1, 2, 5, 10];
/** What a key press at the slider adds [s]. */
const KEY_STEP = 1;

/** @param {number} seconds @param {number} digits behind the point */
export function clock(seconds, digits = 1) {
  const unit = 10 ** digits;
  const parts = Math.max(0, Math.round(seconds * unit));
  const [minutes, rest] = [Math.floor(parts / (60 * unit)), parts % (60 * unit)];
  return `${minutes}:${rest < 10 * unit ? "0" : ""}${(rest / unit).toFixed(digits)}`;
}

/** A time and the length of its recording with the same digits. A step between two messages is
 * often a few milliseconds: they are only shown at rest.
 * @param {number} seconds @param {number} most [s] @param {boolean} playing */
export function clocks(seconds, most, playing) {
  const digits = playing ? 1 : 3;
  return `${clock(seconds, digits)} / ${clock(most, digits)}`;
}

/** Where the time of the recording is, from what was told of it and when.
 * @param {{value: number, at: number}} told @param {number} rate @param {number} most
 * @param {number} now [ms] */
export const timeNow = (told, rate, most, now) =>
  Math.min(most, told.value + (Math.max(0, now - told.at) / 1000) * rate);

/** How far a key goes [s]; undefined for one that goes nowhere.
 * @param {string} key @param {number} most the length of the recording [s]
 * @returns {number | undefined} */
export const keyGoes = (key, most) =>
  /** @type {Record<string, number>} */ ({
    ArrowRight: KEY_STEP,
    ArrowUp: KEY_STEP,
    ArrowLeft: -KEY_STEP,
    ArrowDown: -KEY_STEP,
    PageUp: most / 10,
    PageDown: -most / 10,
    Home: -most,
    End: most,
  })[key];

/** Earlier than this are seconds of a recording, and later ones since 1970 [s]. */
const CALENDAR = 1e8;

/** The time of a recording that was typed: seconds, minutes and seconds, or seconds since 1970 as
 * messages are stamped.
 * @param {string} text @param {number} begin of the recording [s since 1970]
 * @returns {number | null} seconds from its beginning; null for what is none */
export function typedTime(text, begin) {
  const parts = text.trim().replace(/s$/, "").trim().replace(",", ".").split(":");
  const numbers = parts.map((part) =>
    /^\d+(\.\d*)?$|^\.\d+$/.test(part.trim()) ? Number(part) : NaN,
  );
  if (parts.length > 3 || numbers.some(Number.isNaN)) return null;
  const seconds = numbers.reduce((sum, part) => sum * 60 + part, 0);
  return parts.length === 1 && seconds >= CALENDAR && begin >= CALENDAR ? seconds - begin : seconds;
}

/** What the time bar shows [s], and its length. */
let bar = () => ({ shown: 0, most: 0 });

/** @param {number} seconds @param {number} [gesture] */
function go(seconds, gesture) {
  const inside = Math.min(bar().most, Math.max(0, seconds));
  // The next key goes on from there, though the picture is still to come.
  rows.hope("player/time", inside);
  send("player/time", inside, gesture || newGesture());
}

/** Send what a hand does with the player. @param {string} key */
export const seek = (key) => go(bar().shown + (keyGoes(key, bar().most) || 0));
export const play = () => send("player/playing", !rows.value("player/playing"));
/** @param {boolean} back */
export const step = (back) => act("player/step", [back]);

/** A line for each thing that sources can: what seeks is played, of live robots is told how they are.
 * @param {{openOther: () => void}} props opens another recording */
export function PlayerBar({ openOther }) {
  const [time, source] = [useRow("player/time"), useData("source/status")];
  if (!time && !source) return null;
  return html`<div class="bars">
    ${time && html`<section class="player-bar" aria-label="Player"><${Controls} time=${time} openOther=${openOther} /></section>`}
    ${source && html`<${Source} ...${source} />`}
  </div>`;
}

/** @param {number} bytes */
export function sizeText(bytes) {
  const [by, unit] = bytes < 1e6 ? [1e3, "kB"] : bytes < 1e9 ? [1e6, "MB"] : [1e9, "GB"];
  return `${(bytes / by).toFixed(by > 1e3 ? 1 : 0)} ${unit}`;
}

/** How the connection to a live robot is.
 * @param {{name: string, connected: boolean, sentence: string, recording: any}} props */
function Source({ name, connected, sentence, recording }) {
  return html`<section class="player-bar" aria-label="Source">
    <span class=${`source l-${connected ? "ok" : "warn"}`}><${Icon} name=${connected ? "ok" : "warn"} />
      ${connected ? "Live" : "Waiting"}</span>
    <${CutText} is="uri" text=${name} />
    <${CutText} is="sentence" role="status" text=${sentence} />
    <${LiveTime} />
    <${Recording} recording=${recording} />
  </section>`;
}

/** The time of a live robot, from what was told of it and when: that of a simulation goes
 * on at its own rate, any other with the clock of this computer.
 * @param {{simulated: boolean, time: number, rate: number}} told
 * @param {number} since when it was told [ms] @param {number} now [ms] @param {number} wall [s] */
export const liveTime = ({ simulated, time, rate }, since, now, wall) =>
  simulated ? time + (Math.max(0, now - since) / 1000) * rate : wall + time;

/** RViz's Time panel for a live robot. */
function LiveTime() {
  const clock = useData("source/clock");
  const told = useRef({ clock, at: performance.now() });
  if (told.current.clock !== clock) told.current = { clock, at: performance.now() };
  const [, again] = useReducer((/** @type {number} */ n) => n + 1, 0);
  useEffect(() => {
    const timer = setInterval(() => again(0), 1000);
    return () => clearInterval(timer);
  }, []);
  if (!clock) return null;
  const ros = () => liveTime(clock, told.current.at, performance.now(), Date.now() / 1000);
  // A simulation that was reset begins again.
  firstRos = Math.min(firstRos, ros());
  return html`<span class="time"><${Popup} name="Time" role="dialog" title="ROS and wall time"
    label=${`${clock.simulated ? "Simulated " : ""}${ros().toFixed(1)} s`}>
    ${() => html`<${Times} ros=${ros} first=${() => firstRos} />`}<//></span>`;
}

/** What is recorded, and the button for it where the command line allows it.
 * @param {{recording: {name: string, running: boolean, seconds: number, size: number,
 *   trouble: string} | null}} props */
function Recording({ recording }) {
  const [record, stop] = [useCommand("source/record"), useCommand("source/stop")];
  const { name = "", running = false, seconds = 0, size = 0, trouble = "" } = recording || {};
  const length = `${Math.floor(seconds / 60)}:${String(seconds % 60).padStart(2, "0")}`;
  return html`
    ${
      recording &&
      html`<${CutText} is=${`recording ${running ? "running" : ""}`}
      text=${`${running ? "Recording" : "Recorded"} ${name}, ${length}, ${sizeText(size)}`} />`
    }
    ${trouble && html`<${CutText} is="l-warn trouble" role="status" text=${trouble} />`}
    ${
      record &&
      html`<button title="Record all topics to a new file on the server"
      onClick=${() => act("source/record")}>Record</button>`
    }
    ${
      stop &&
      html`<button title="End the recording and close its file"
      onClick=${() => act("source/stop")}>Stop</button>`
    }`;
}

/** @param {{time: any, openOther: () => void}} props */
function Controls({ time, openOther }) {
  const playing = Boolean(useRow("player/playing")?.value);
  const rate = useRow("player/rate")?.value ?? 1;
  const loop = Boolean(useRow("player/loop")?.value);
  const begin = useData("player/begin") || 0;
  const name = useData("player/name");
  const others = useData("recording/state");
  const [, again] = useReducer((/** @type {number} */ n) => n + 1, 0);
  /** What was told of the time, and when. @type {{current: {value: number, at: number}}} */
  const told = useRef({ value: time.value, at: performance.now() });
  const went = useRef(playing);
  if (told.current.value !== time.value || went.current !== playing)
    told.current = { value: time.value, at: performance.now() };
  went.current = playing;
  useEffect(() => {
    if (!playing) return undefined;
    // A few pictures of the line a second are enough for the eye.
    const timer = setInterval(() => again(0), 100);
    return () => clearInterval(timer);
  }, [playing]);
  const gesture = useRef(0);
  const most = time.max || 0;
  const now = () => (playing ? timeNow(told.current, rate, most, performance.now()) : time.value);
  bar = () => ({ shown: now(), most });
  const shown = now();
  /** @param {Key} event */
  const key = (event) => {
    if (keyGoes(event.key, most) === undefined) return;
    event.preventDefault();
    seek(event.key);
  };
  const short = clocks(shown, most, playing);
  const words = `${clock(shown)} of ${clock(most)}`;
  return html`
    <${CutText} is="recording-name" text=${name} />
    ${
      others &&
      html`<button class="flat needs-control" aria-label="Open recording" title="Open another recording"
      onClick=${openOther}><${Icon} name="open" /></button>`
    }
    <button class="play needs-control" aria-keyshortcuts="Space" title=${`${playing ? "Pause" : "Play"} (space bar)`}
      onClick=${play}><${Icon} name=${playing ? "pause" : "play"} />${playing ? "Pause" : "Play"}</button>
    <button class="flat needs-control" aria-label="To the beginning" title="To the beginning (Home)"
      onClick=${() => seek("Home")}><${Icon} name="toBegin" /></button>
    <button class="flat needs-control" aria-keyshortcuts="," aria-label="Message before" title="Message before (,)"
      onClick=${() => step(true)}><${Icon} name="stepBack" /></button>
    <button class="flat needs-control" aria-keyshortcuts="." aria-label="Next message" title="Next message (.)"
      onClick=${() => step(false)}><${Icon} name="stepOn" /></button>
    <${Topic} />
    <input class="needs-control" type="range" aria-label="Time" min="0" max=${most} step="any"
      value=${shown} aria-valuetext=${words}
      onPointerDown=${() => (gesture.current = newGesture())}
      onPointerUp=${() => (gesture.current = 0)}
      onInput=${(/** @type {any} */ event) =>
        go(Number(event.currentTarget.value), gesture.current)}
      onKeyDown=${key} />
    <span class="time" style=${`--chars: ${clocks(most, most, false).length}`}>
      <${Popup} name="Time" role="dialog" title="ROS and wall time" label=${short}>
      ${(
        /** @type {() => void} */ close,
      ) => html`<${GoTo} begin=${begin} most=${most} close=${close} />
        <${Times} ros=${() => begin + now()} first=${() => begin} />`}<//></span>
    <label class="rate">Rate <select class="needs-control" aria-label="Rate" value=${String(rate)}
      onChange=${(/** @type {any} */ event) => send("player/rate", Number(event.currentTarget.value))}>
      ${[...new Set([...RATES, rate])]
        .sort((a, b) => a - b)
        .map((one) => html`<option value=${String(one)} selected=${one === rate}>${one}×</option>`)}
    </select></label>
    <button class="loop needs-control" aria-pressed=${String(loop)} title="Begin again at the end"
      onClick=${() => send("player/loop", !loop)}><${Icon} name="loop" />Loop</button>`;
}

/** When the page was opened [s since 1970]. */
const OPENED = Date.now() / 1000;
/** The time of a live robot when the page first had it, or that of a reset before it [s]. */
let firstRos = Infinity;

/** A setting with a few values to choose from, in the order of the server; an empty list is not sent.
 * @param {{row: any, none?: string}} props none: why there may be nothing to choose from */
function Choice({ row, none }) {
  const { value = "", options = [] } = row;
  const shown = options.includes(value) ? options : [value, ...options];
  const isEmpty = !shown.some(Boolean);
  return html`<label>${row.name} <select class="needs-control" disabled=${isEmpty}
    title=${(isEmpty && none) || row.help} value=${value}
    onChange=${(/** @type {any} */ event) => send(row.id, event.currentTarget.value)}>
    ${shown.map(
      (/** @type {string} */ one) =>
        html`<option value=${one} selected=${one === value}>${one || "none"}</option>`,
    )}</select></label>`;
}

const NO_TIMES = "No display shows messages that have a time";

/** At which display's times frames are drawn, as RViz's Time panel sets it. */
function Synchronization() {
  const [mode, source] = [useRow("time/mode"), useRow("time/source")];
  if (!mode || !source) return null;
  return html`<div class="synchronization"><${Choice} row=${mode} />
    ${mode.value !== "Off" && html`<${Choice} row=${source} none=${NO_TIMES} />`}</div>`;
}

/** What RViz's Time panel shows: seconds since 1970 and since the first of them, of the messages
 * and of the wall. @param {number} ros @param {number} wall
 * @param {number} first the beginning of a recording, so that what elapsed is the time of the player
 * @returns {[string, string][]} */
export const times = (ros, wall, first, opened = OPENED) => [
  ["ROS Time", ros.toFixed(2)],
  ["ROS Elapsed", (ros - first).toFixed(2)],
  ["Wall Time", wall.toFixed(2)],
  ["Wall Elapsed", (wall - opened).toFixed(2)],
];

/** A field for an exact time.
 * @param {{begin: number, most: number, close: () => void}} props */
function GoTo({ begin, most, close }) {
  const [wrong, setWrong] = useState("");
  /** @param {any} event */
  const typed = (event) => {
    event.preventDefault();
    const seconds = typedTime(event.currentTarget.elements.time.value, begin);
    if (seconds === null) setWrong("Write seconds, or minutes:seconds.");
    else if (seconds < 0 || seconds > most) setWrong(`Write a time up to ${clock(most, 3)}.`);
    else {
      go(seconds);
      close();
    }
  };
  return html`<form class="go-to" onSubmit=${typed}>
    <label>Go to <input class="needs-control" name="time" autocomplete="off" size="12"
      placeholder="1:02.5" aria-invalid=${String(Boolean(wrong))}
      title="Seconds, minutes:seconds, or seconds since 1970" /></label>
    <button class="needs-control">Go</button>
    ${wrong && html`<p class="l-error" role="alert">${wrong}</p>`}
  </form>`;
}

/** @param {{ros: () => number, first: () => number}} props */
function Times({ ros, first }) {
  // Where frames are drawn at another time than the latest, that is RViz's ROS time.
  const behind = useData("time/behind") || 0;
  const [, again] = useReducer((/** @type {number} */ n) => n + 1, 0);
  useEffect(() => {
    const timer = setInterval(() => again(0), 100);
    return () => clearInterval(timer);
  }, []);
  return html`<table class="times">${times(ros() - behind, Date.now() / 1000, first()).map(
    ([name, seconds]) =>
      html`<tr key=${name}><th scope="row">${name}</th><td>${seconds} s</td></tr>`,
  )}</table><${Synchronization} />`;
}

/** Whose messages the steps go to. A recording may have hundreds of topics, and each choice is seven
 * nodes: the others than the chosen one are there as soon as a hand or the keys come. */
function Topic() {
  const row = useRow("player/topic");
  const [filled, setFilled] = useState(false);
  if (!row) return null;
  const fill = () => setFilled(true);
  const options = (filled && row.options) || [row.value];
  return html`<select class="topic needs-control" aria-label="Step to messages of" title=${row.help}
    value=${row.value} onPointerDown=${fill} onFocus=${fill}
    onChange=${(/** @type {any} */ event) => send("player/topic", event.currentTarget.value)}>
    ${options.map(
      (/** @type {string} */ one) =>
        html`<option value=${one} selected=${one === row.value}>${one === "any" ? "any topic" : one}</option>`,
    )}
  </select>`;
}

// @ts-check
/* The player below the view: the time of a recording. While it plays, the page lets its
 * own time go on, and is told once in a while where the recording is. */

import { html, useEffect, useReducer, useRef } from "../vendor/preact.js";
import { useData, useRow } from "../state.js";
import { act, newGesture, rows, send } from "../wire/channel.js";
import { Icon } from "./icons.js";

const RATES = [0.1, 0.25, 0.5, 1, 2, 5, 10];
/** What a key press at the slider adds [s]. */
const KEY_STEP = 1;

/** @param {number} seconds */
export function clock(seconds) {
  const tenths = Math.max(0, Math.round(seconds * 10));
  const [minutes, rest] = [Math.floor(tenths / 600), tenths % 600];
  const short = (rest / 10).toFixed(1);
  return `${minutes}:${rest < 100 ? "0" : ""}${short}`;
}

/** Where the time of the recording is, from what was told of it and when.
 * @param {{value: number, at: number}} told @param {number} rate @param {number} most
 * @param {number} now [ms] */
export const timeNow = (told, rate, most, now) =>
  Math.min(most, told.value + (Math.max(0, now - told.at) / 1000) * rate);

/** Send what a hand does with the player. */
export const play = () => send("player/playing", !rows.value("player/playing"));
/** @param {boolean} back */
export const step = (back) => act("player/step", [back]);

export function PlayerBar() {
  const time = useRow("player/time");
  const source = useData("source/status");
  if (source) return html`<${Source} ...${source} />`;
  if (!time) return null;
  return html`<section class="player-bar" aria-label="Player"><${Controls} time=${time} />
  </section>`;
}

/** How the connection to a live robot is.
 * @param {{name: string, connected: boolean, sentence: string}} props */
function Source({ name, connected, sentence }) {
  return html`<section class="player-bar" aria-label="Source">
    <span class=${`source l-${connected ? "ok" : "warn"}`}><${Icon} name=${connected ? "ok" : "warn"} />
      ${connected ? "Live" : "Waiting"}</span>
    <span class="uri" title=${name}>${name}</span>
    <span class="sentence" role="status" title=${sentence}>${sentence}</span>
  </section>`;
}

/** @param {{time: any}} props */
function Controls({ time }) {
  const playing = Boolean(useRow("player/playing")?.value);
  const rate = useRow("player/rate")?.value ?? 1;
  const loop = Boolean(useRow("player/loop")?.value);
  const begin = useData("player/begin") || 0;
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
  const shown = playing ? timeNow(told.current, rate, most, performance.now()) : time.value;
  /** @param {number} seconds */
  const go = (seconds) =>
    send("player/time", Math.min(most, Math.max(0, seconds)), gesture.current || newGesture());
  /** @param {Key} event */
  const key = (event) => {
    const by = /** @type {Record<string, number>} */ ({
      ArrowRight: KEY_STEP,
      ArrowUp: KEY_STEP,
      ArrowLeft: -KEY_STEP,
      ArrowDown: -KEY_STEP,
      PageUp: most / 10,
      PageDown: -most / 10,
      Home: -most,
      End: most,
    })[event.key];
    if (by === undefined) return;
    event.preventDefault();
    go(shown + by);
  };
  const words = `${clock(shown)} of ${clock(most)}`;
  return html`
    <button class="play needs-control" aria-keyshortcuts="Space" title=${`${playing ? "Pause" : "Play"} (space bar)`}
      onClick=${play}><${Icon} name=${playing ? "pause" : "play"} />${playing ? "Pause" : "Play"}</button>
    <button class="flat needs-control" aria-keyshortcuts="," aria-label="Message before" title="Message before (,)"
      onClick=${() => step(true)}><${Icon} name="stepBack" /></button>
    <button class="flat needs-control" aria-keyshortcuts="." aria-label="Next message" title="Next message (.)"
      onClick=${() => step(false)}><${Icon} name="stepOn" /></button>
    <${Topic} />
    <input class="needs-control" type="range" aria-label="Time" min="0" max=${most} step="any"
      value=${shown} aria-valuetext=${words}
      onPointerDown=${() => (gesture.current = newGesture())}
      onPointerUp=${() => (gesture.current = 0)}
      onInput=${(/** @type {any} */ event) => go(Number(event.currentTarget.value))}
      onKeyDown=${key} />
    <span class="time" title=${`Source time ${(begin + shown).toFixed(3)} s`}>${clock(shown)} / ${clock(most)}</span>
    <label class="rate">Rate <select class="needs-control" aria-label="Rate" value=${String(rate)}
      onChange=${(/** @type {any} */ event) => send("player/rate", Number(event.currentTarget.value))}>
      ${[...new Set([...RATES, rate])]
        .sort((a, b) => a - b)
        .map((one) => html`<option value=${String(one)} selected=${one === rate}>${one}×</option>`)}
    </select></label>
    <button class="flat needs-control" aria-pressed=${String(loop)} title="Begin again at the end"
      onClick=${() => send("player/loop", !loop)}>Loop</button>`;
}

/** Whose messages the steps go to. */
function Topic() {
  const row = useRow("player/topic");
  if (!row) return null;
  return html`<select class="topic needs-control" aria-label="Step to messages of" title=${row.help}
    value=${row.value} onChange=${(/** @type {any} */ event) => send("player/topic", event.currentTarget.value)}>
    ${(row.options || []).map(
      (/** @type {string} */ one) =>
        html`<option value=${one} selected=${one === row.value}>${one === "any" ? "any topic" : one}</option>`,
    )}
  </select>`;
}

// @ts-check
/* A page that is a file: it shows a robot without a server, and plays its motion. */

import "../view/rviz_look.js";
import "../view/rviz_mouse.js";
import { moveCamera, takeCamera } from "../view/camera.js";
import { at, read } from "./tracks.js";

/** @typedef {{title: string, duration: number, view: {kind: string}, size: [number, number],
 *   camera: import("../view/camera.js").Told}} About
 *   size: width and height of the picture that the camera was set for [px]
 *   camera: what a server says of it */

/** viser's objects have no types here. @type {any} */
const globals = window;
/** @param {string} id */
const written = (id) => document.getElementById(id)?.textContent || "";
/** @type {About} */
const about = JSON.parse(written("sambot-about"));

/** @param {number} seconds */
const shown = (seconds) => `${seconds.toFixed(1)} s`;

/** Whether viser has drawn the first picture. */
const isReady = () => {
  const page = globals.__viserMutable;
  return Boolean(
    page?.scene &&
    page.cameraControl &&
    page.messageQueue.length === 0 &&
    globals.sambotVizLook?.frames &&
    "/~ambient" in globals.__viserSceneTree.getState(),
  );
};

/** A function of viser's scene is called as soon as there is one. @param {() => void} then */
function whenReady(then) {
  if (isReady()) then();
  else setTimeout(() => whenReady(then), 50);
}

/** In a narrower window the camera is farther away, so that as much is seen to the sides. */
function makeRoom() {
  const { canvas, cameraControl, requestRender } = globals.__viserMutable;
  const [width, height] = about.size;
  const narrower = width / height / (canvas.clientWidth / canvas.clientHeight);
  if (about.view.kind === "TopDownOrtho" || about.view.kind === "FPS" || !(narrower > 1)) return;
  cameraControl.dollyTo(cameraControl.distance * narrower, false);
  requestRender();
}

class Player {
  /** @param {import("./tracks.js").Track[]} tracks */
  constructor(tracks) {
    this.tracks = tracks;
    this.time = 0;
    this.playing = false;
    this.loop = true;
    this.last = 0;
    this.changed = () => {};
  }

  /** Show a time. @param {number} time [s] */
  go(time) {
    this.time = Math.max(0, Math.min(about.duration, time));
    const page = globals.__viserMutable;
    const messages = at(this.tracks, this.time * 1000);
    if (messages.length) {
      page.messageQueue.push(...messages);
      page.requestRender();
    }
    this.changed();
  }

  /** @param {boolean} on */
  play(on) {
    if (on === this.playing) return;
    this.playing = on;
    if (on && this.time >= about.duration) this.go(0);
    this.last = performance.now();
    if (on) requestAnimationFrame((now) => this.step(now));
    this.changed();
  }

  /** @param {number} now [ms] */
  step(now) {
    if (!this.playing) return;
    const next = this.time + Math.max(0, now - this.last) / 1000;
    this.last = now;
    if (next < about.duration) this.go(next);
    else if (this.loop) this.go(next % about.duration);
    else {
      this.go(about.duration);
      this.play(false);
      return;
    }
    requestAnimationFrame((then) => this.step(then));
  }
}

/**
 * @param {string} tag
 * @param {Record<string, string>} attributes
 * @param {...(Node | string)} inside
 */
function element(tag, attributes, ...inside) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...inside);
  return made;
}

/** The line below the view. @param {Player} player */
function bar(player) {
  const play = element("button", { class: "play", title: "Play or pause (space bar)" });
  const slider = /** @type {HTMLInputElement} */ (
    element("input", {
      type: "range",
      "aria-label": "Time",
      min: "0",
      max: String(about.duration),
      step: String(Math.min(0.1, about.duration / 20)),
      value: "0",
    })
  );
  const time = element("span", { class: "time", "aria-hidden": "true" });
  const loop = element("button", { title: "Repeat at the end" }, "Loop");
  player.changed = () => {
    play.textContent = player.playing ? "Pause" : "Play";
    loop.setAttribute("aria-pressed", String(player.loop));
    if (document.activeElement !== slider || player.playing) slider.value = String(player.time);
    slider.setAttribute("aria-valuetext", `${shown(player.time)} of ${shown(about.duration)}`);
    time.textContent = `${shown(player.time)} / ${shown(about.duration)}`;
  };
  play.onclick = () => player.play(!player.playing);
  loop.onclick = () => {
    player.loop = !player.loop;
    player.changed();
  };
  slider.oninput = () => {
    player.play(false);
    player.go(Number(slider.value));
  };
  // The space bar would press what a mouse has clicked on.
  loop.addEventListener("click", (event) => event.detail && loop.blur());
  addEventListener("keydown", (event) => {
    if (event.key !== " " || event.repeat || event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.target instanceof HTMLButtonElement) return;
    event.preventDefault();
    play.click();
  });
  player.changed();
  return element(
    "div",
    { class: "player", role: "group", "aria-label": "Motion" },
    play,
    slider,
    time,
    loop,
  );
}

async function start() {
  document.title = about.title;
  // The mouse moves the camera as in this view.
  globals.sambotViz = { ...globals.sambotViz, view: about.view };
  const name = element("h1", {}, about.title);
  const line = element("div", { class: "line" }, name);
  const host = element("div", { id: "sambot" }, line);
  document.body.append(host);
  document.body.classList.add("sambot-player");
  // Only browsers before 2023 cannot read it: they show the robot at rest.
  const tracks = about.duration > 0 ? await read(written("sambot-motion")).catch(() => null) : [];
  whenReady(() => {
    takeCamera(about.camera);
    moveCamera();
    makeRoom();
    if (!tracks)
      line.append(element("p", { role: "status" }, "This browser is too old to play the motion."));
    else if (tracks.length) line.append(bar(new Player(tracks)));
    host.dataset.ready = "yes";
  });
}
// The script may be there before the page's body is.
if (document.readyState !== "loading") start();
else addEventListener("DOMContentLoaded", start);

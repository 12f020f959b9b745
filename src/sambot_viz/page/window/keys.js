// @ts-check
/* Keys for the whole window. None acts while a text is typed or a dialog is open. */

/** @typedef {{key: string, code?: string, ctrlKey?: boolean, metaKey?: boolean, altKey?: boolean,
 *   shiftKey?: boolean, repeat?: boolean}} Key */
/** What a key does: a command with its arguments, "hide" for the panels, "play" to
 * play or pause, a key of the time bar.
 * @typedef {{act: string, with?: any[]} | "hide" | "play" | {seek: string}} Meaning */

const NO_LETTERS = new Set([
  "checkbox",
  "range",
  "color",
  "radio",
  "button",
  "submit",
  "reset",
  "file",
]);

/** The sides from which a key looks at the robot; again, from the opposite one.
 * @type {Record<string, string>} */
const SIDES = { 1: "front", 3: "right", 7: "top" };

/** Keys that move the time of a recording, also when they are held. */
const SEEKS = new Set(["ArrowLeft", "ArrowRight", "Home", "End"]);

/** Whether what has the focus takes letters. @param {any} target */
export function isTyping(target) {
  const tag = String(target?.tagName || "").toUpperCase();
  if (tag === "INPUT") return !NO_LETTERS.has(target.type);
  return tag === "TEXTAREA" || tag === "SELECT" || Boolean(target?.isContentEditable);
}

/**
 * The letter of a key; on a keyboard without Latin letters, the one at its place.
 * @param {Key} event
 */
function letter({ key, code = "" }) {
  const named = key.length > 1 || /^[\x20-\x7e]$/.test(key);
  return (named ? key : code.replace(/^Key/, "")).toLowerCase();
}

/**
 * What a key means while nothing is typed.
 * @param {Key} event
 * @param {{name: string, key: string}[]} tools
 * @param {[number | null, number | null]} mouse where it is in the view, for Focus
 * @param {boolean} drives whether the hand is in the Drive panel
 * @returns {Meaning | undefined}
 */
export function meaning(event, tools, mouse = [null, null], drives = false) {
  const key = letter(event);
  if (event.altKey) return undefined;
  if (event.ctrlKey || event.metaKey) {
    if (key === "z") return { act: event.shiftKey ? "edit/redo" : "edit/undo" };
    return key === "y" ? { act: "edit/redo" } : undefined;
  }
  if (SEEKS.has(event.key)) return event.shiftKey ? undefined : { seek: event.key };
  // A key that is held would go to and fro.
  if (event.repeat) return undefined;
  if (key === " ") return "play";
  if (key === "," || key === ".") return { act: "player/step", with: [key === ","] };
  if (key === "escape") return { act: "tools/escape" };
  const tool = tools.find((one) => one.key === key);
  if (tool) return { act: "tools/press", with: [tool.name] };
  if (key === "f") return { act: "tools/focus", with: mouse };
  if (key === "z") return { act: "tools/zero" };
  if (key === "r") return { act: "tools/reset" };
  if (key === "o") return { act: "tools/point" };
  // As in Blender; while a number pad drives, its other keys are only pressed by mistake.
  if (!drives && SIDES[key]) return { act: "views/press_side", with: [SIDES[key]] };
  // A number pad drives the robot: 8 and 2 forwards and back, 4 and 6 turn, 5 stops. A digit
  // that was meant for a field must not: only stopping is always safe.
  if (key === "5" || (drives && "2468".includes(key))) return { act: "drive/press", with: [key] };
  return key === "h" ? "hide" : undefined;
}

/** A second press within that time stops the robot [ms]. */
const TWICE = 600;

/** Where digits drive the robot. */
const DRIVE = ".drive, [data-tab=drive]";

/** Where arrow keys have no other use: nothing there is moved or scrolled by them. */
const NO_ARROWS = "body, canvas, #no-view, .player-bar button";

/** Where a mouse clicks without meaning to leave the keyboard there. */
const PASSING = ".top button, .player-bar button, .statusbar button";

/** What keeps the keys of the window for itself. */
const OPEN = "dialog[open], [role=dialog], [role=alertdialog], [role=menu]";

/**
 * Let go of the focus that a mouse has set on the way: the keys of the player would stop.
 * @param {() => boolean} plays
 */
function letGo(plays) {
  let byMouse = false;
  addEventListener("pointerdown", () => (byMouse = true), true);
  addEventListener("keydown", () => (byMouse = false), true);
  /** @param {string} passing */
  const leave = (passing) => {
    const has = document.activeElement;
    if (plays() && has instanceof HTMLElement && has.matches(passing)) has.blur();
  };
  // A key that presses a button is no click of a mouse.
  addEventListener("click", (event) => event.detail && leave(PASSING));
  addEventListener("change", () => byMouse && leave(".player-bar select"));
}

/**
 * Follow the keyboard.
 * @param {{tools: () => {name: string, key: string}[], mouse: () => [number | null, number | null],
 *   act: (id: string, args?: any[]) => void, drivesRobot: () => boolean, hide: () => void,
 *   cancelPress: () => void,
 *   plays: () => boolean, play: () => void, seek: (key: string) => void}} window
 */
export function listenToKeys({
  tools,
  mouse,
  act,
  drivesRobot,
  hide,
  cancelPress,
  plays,
  play,
  seek,
}) {
  letGo(plays);
  let escaped = -Infinity;
  // Whatever else the keys mean, and wherever the focus is.
  addEventListener(
    "keydown",
    (event) => {
      const isTwice = event.key === "Escape" && event.timeStamp - escaped < TWICE;
      if (event.key === "Escape" && !event.repeat) escaped = event.timeStamp;
      if (!isTwice && !(event.key === " " && drivesRobot())) return;
      if (!event.repeat) act("live/stop");
    },
    true,
  );
  addEventListener("keydown", (event) => {
    if (event.defaultPrevented || isTyping(event.target) || document.querySelector(OPEN)) return;
    // The text of the whole page is never meant.
    if ((event.ctrlKey || event.metaKey) && letter(event) === "a") return event.preventDefault();
    const drives = event.target instanceof Element && Boolean(event.target.closest(DRIVE));
    const does = meaning(event, tools(), mouse(), drives);
    if (!does) return;
    if (event.key === "Escape") cancelPress();
    // A button that has the focus is pressed by the space bar.
    if (does === "play" && (!plays() || event.target instanceof HTMLButtonElement)) return;
    if (typeof does === "object" && "seek" in does) {
      const free = event.target instanceof Element && event.target.matches(NO_ARROWS);
      if (!plays() || !free) return;
      seek(does.seek);
    } else if (does === "hide") hide();
    else if (does === "play") play();
    else act(does.act, does.with);
    event.preventDefault();
  });
}

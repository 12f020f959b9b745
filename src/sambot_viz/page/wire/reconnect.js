// @ts-check
/* What a page remembers while it has no connection, and what a program that was started
 * again has lost of it. */

import { act, rows } from "./channel.js";
import { folds } from "../state.js";

/**
 * @typedef {{session: string | undefined, edits: string | undefined, folds: Record<string, boolean>, places: Record<string, string>, view: Record<string, any>,
 *   joints: Record<string, {value: number, first: number}>, frames: string[], poses: string[], turning: boolean,
 *   selected: boolean, modified: boolean, robot: {drives: boolean, away: boolean}, file: {name?: string, own?: boolean, folder?: string}}} Memory
 *   edits: the key of what can be undone
 *   places: where each display is, by its id
 *   robot: whether it drove, and whether it was not at its start
 *   joints: those that were moved, and where they were at first
 */

/** @param {string[]} names */
const has = (...names) => names.some((name) => rows.value(`drive/${name}`));

/** The target frame of a view that follows none. */
const FIXED = "<Fixed Frame>";

/** How things are now. @returns {Memory} */
export function remember() {
  const { name, own, folder, modified } = rows.data("file/state") || {};
  return {
    session: rows.data("names/session")?.id,
    edits: rows.data("edit/key"),
    folds: folds.value,
    places: places(),
    view: view(),
    joints: moved(),
    frames: frames(),
    poses: rows.data("poses/names") || [],
    turning: Boolean(rows.data("joints/turning")?.length),
    selected: ids("selection").some((id) => id.startsWith("selected/")),
    modified: Boolean(modified),
    robot: { drives: has("linear", "angular"), away: has("x", "y") },
    file: { name, own, folder },
  };
}

/** Of a memory what another robot can take over. @param {Memory} before @returns {Memory} */
export const withoutRobot = ({ session, folds, places, view, robot }) => ({
  session,
  edits: undefined,
  folds,
  places,
  view,
  joints: {},
  frames: [],
  poses: [],
  turning: false,
  selected: false,
  modified: false,
  robot,
  file: {},
});

/** @param {string} panel */
const ids = (panel) => rows.panels.get(panel) || [];
/** @param {string} id */
const first = (id) => rows.data("joints/first")?.[id] ?? 0;
const frames = () =>
  ids("frames")
    .filter((id) => rows.get(id)?.static)
    .map((id) => rows.get(id)?.name || "");

/** The joints that are not where they were at first. */
function moved() {
  const sliders = ids("joints").filter(
    (id) => rows.get(id)?.kind === "slider" && !rows.get(id)?.fixed,
  );
  return Object.fromEntries(
    sliders
      .filter((id) => rows.value(id) !== first(id))
      .map((id) => [id, { value: rows.value(id), first: first(id) }]),
  );
}

/** Where each display is: its name, and those above, each with its number among those of the same name. */
function places() {
  /** @type {Record<string, string>} */
  const found = {},
    /** @type {Record<string, number>} */ seen = {};
  for (const id of ids("displays")) {
    const row = rows.get(id);
    if (!row?.display) continue;
    const path = `${found[row.in] || ""}\n${row.name}`;
    seen[path] = (seen[path] || 0) + 1;
    found[id] = `${path}\n${seen[path]}`;
  }
  return found;
}

/** The id that a row has now, by the one it had; null when its display is not there. Displays
 * have other numbers in another document, and in a program that was started again.
 * @param {Memory} before @returns {(id: string) => string | null} */
export function idsNow(before) {
  const now = Object.fromEntries(Object.entries(places()).map(([id, place]) => [place, id]));
  return (id) => {
    const [head, ...rest] = id.split("/"),
      place = before.places[head];
    if (place === undefined) return id;
    return now[place] ? [now[place], ...rest].join("/") : null;
  };
}

/** The folds of displays that are still there. @param {Memory} before @param {Record<string, boolean>} of */
export function foldsNow(before, of) {
  const now = idsNow(before);
  return Object.fromEntries(
    Object.entries(of).flatMap(([id, open]) => {
      const there = now(id);
      return there === null ? [] : [[there, open]];
    }),
  );
}

/** The values of this page's view; none of one that only waits for a robot.
 * @returns {Record<string, any>} */
function view() {
  if (rows.data("view/waits")) return {};
  const set = ids("views")
    .map((id) => rows.get(id))
    .filter(
      (row) =>
        row?.id.startsWith("view/") &&
        !row.fixed &&
        row.part === undefined &&
        !["view/:lead", "view/:follow"].includes(row.id),
    );
  return Object.fromEntries(set.map((row) => [row?.id, row?.value]));
}

/** Show the view that this page had.
 * @param {Memory} before @param {boolean} [camera] false: the page still has its camera, which a hand may have moved since */
export function showView({ view: { "view/type": type, ...values } }, camera = true) {
  if (type === undefined) {
    // A page that was loaded again shows the first view by itself.
    if (!camera && rows.knows("views/first")) act("views/first");
    return;
  }
  // The frame that is followed is elsewhere now, or not there yet: the camera that the page
  // has says where the frame was.
  const all = camera || values["view/Target Frame"] !== FIXED;
  const kept = Object.entries(values).filter(
    ([id, value]) => all || typeof value === "boolean" || rows.get(id)?.kind === "frame",
  );
  act("views/restore", [type, JSON.stringify(Object.fromEntries(kept))]);
}

/** Whether the robot is there, and its joints with it. */
export const hasJoints = () => rows.data("joints/untouched") !== undefined;

/** The joints that a program which was started again has put elsewhere, and where they were. A
 * joint with another start is left there: that is what its user has asked for now.
 * @param {Memory} before @returns {[string[], number[]]} */
export function jointsToBringBack(before) {
  const wanted = Object.entries(before.joints).filter(([id, { value, first: was }]) => {
    const row = rows.get(id);
    return (
      row &&
      first(id) === was &&
      row.value !== value &&
      value >= (row.min ?? -Infinity) &&
      value <= (row.max ?? Infinity)
    );
  });
  return [wanted.map(([id]) => id), wanted.map(([, { value }]) => value)];
}

/** What there was and is not any more, in words. @param {Memory} before @returns {string[]} */
export function lost(before) {
  const again = before.session !== rows.data("names/session")?.id;
  const gone = before.frames.filter((name) => !frames().includes(name)),
    known = rows.data("poses/names") || before.poses;
  const poses = before.poses.filter((name) => !known.includes(name));
  return [
    gone.length && `the static transform${gone.length > 1 ? "s of" : " of"} ${listed(gone)}`,
    poses.length && `the pose${poses.length > 1 ? "s" : ""} ${listed(poses)}`,
    again &&
      before.modified &&
      `changes of ${before.file.name || "the config"} that were not saved`,
    again && before.turning && "the turning of wheels",
    before.selected &&
      !ids("selection").some((id) => id.startsWith("selected/")) &&
      "the selection",
  ].filter((part) => typeof part === "string");
}

/** The config that was open, when another one is open now. @param {Memory} before */
export function otherConfig(before) {
  const { name, folder } = before.file,
    now = rows.data("file/state");
  return name && now && (name !== now.name || folder !== now.folder) ? before.file : null;
}

/** A list in a sentence. @param {string[]} parts */
export function listed(parts) {
  const few = parts.length > 4 ? [...parts.slice(0, 3), `${parts.length - 3} more`] : parts;
  return few.length < 2
    ? few.join("")
    : `${few.slice(0, -1).join(", ")} and ${few[few.length - 1]}`;
}

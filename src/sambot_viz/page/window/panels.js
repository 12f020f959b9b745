// @ts-check
/* The panels of the window: which there are, which are shown, and how one is opened. */

import { html } from "../vendor/preact.js";
import { DisplaysPanel } from "../panels/displays.js";
import { DrivePanel } from "../panels/drive.js";
import { FramesPanel } from "../panels/frames.js";
import { GraphPanel } from "../panels/graph.js";
import { ImagesPanel } from "../panels/images.js";
import { LessonPanel } from "../panels/lesson.js";
import { ModelPanel } from "../panels/model.js";
import { ComparePanel } from "../panels/compare.js";
import { LiveDrivePanel } from "../panels/live_drive.js";
import { JointsPanel } from "../panels/joints.js";
import { ProblemsPanel } from "../panels/problems.js";
import { SentPanel } from "../panels/sent.js";
import { TopicsPanel } from "../panels/topics.js";
import { ViewsPanel } from "../panels/views.js";
import { Cell, fold, wantedRow } from "../state.js";
import { reveal, Tree } from "../tree/tree.js";
import { rows } from "../wire/channel.js";
import { hidden, shape } from "./splitters.js";

/** The chosen tab at the right, or in the sheet of a phone; "" until somebody chooses one.
 * @type {Cell<string>} */
export const tab = new Cell("", "tab");

/**
 * The panels that are chosen by tabs; a new one is a file and a line here.
 * @type {Record<string, {title: string, short?: string, content: any}>} short: where there are many
 *   tabs
 */
export const TABS = {
  joints: { title: "Joints", content: JointsPanel },
  model: { title: "Model", content: ModelPanel },
  compare: { title: "Compare", content: ComparePanel },
  frames: { title: "Frames", content: FramesPanel },
  graph: { title: "Graph", content: GraphPanel },
  images: { title: "Images", content: ImagesPanel },
  topics: { title: "Topics", content: TopicsPanel },
  selection: {
    title: "Selection",
    content: () => html`<${Tree} panel="selection" label="Selection" />`,
  },
  drive: { title: "Drive", content: DrivePanel },
  live: { title: "Drive robot", short: "Drive", content: LiveDrivePanel },
  sent: { title: "Sent", content: SentPanel },
  tool_properties: {
    title: "Tool Properties",
    short: "Tool",
    content: () => html`<${Tree} panel="tool_properties" label="Tool Properties" />`,
  },
};
/** @type {Record<string, {title: string, short?: string, content: any}>} */
export const SHEET = {
  lesson: { title: "Lesson", content: LessonPanel },
  joints: TABS.joints,
  displays: { title: "Displays", content: DisplaysPanel },
  views: { title: "Views", content: ViewsPanel },
  ...TABS,
  problems: { title: "Problems", content: ProblemsPanel },
};

/** Whether there is a lesson: at the left it is in front of the other panels, or behind them. */
export const hasLesson = () => Boolean(rows.panels.get("lesson")?.length);

/** What else a shown panel changes: which one is in front at the left. @param {string} name */
export const inFront = (name) =>
  hasLesson() && !(name in TABS) && name !== "problems" ? { lesson: name !== "lesson" } : {};

/** Show a panel, wherever it is. @param {string} name */
export function openPanel(name) {
  if (hidden.value.all) hidden.set({ ...hidden.value, all: false });
  if (shape.value !== "wide") return choose(name);
  if (name === "problems") return showProblems(true);
  const side = name in TABS ? "right" : "left";
  hidden.set({ ...hidden.value, [side]: false, [name]: false, ...inFront(name) });
  if (name in TABS) choose(name);
}

wantedRow.listeners.add(() => {
  const wanted = wantedRow.value;
  if (!wanted) return;
  openPanel(wanted.panel);
  fold(wanted.id, true);
  reveal(wanted.panel, wanted.id);
});

/** Show a panel that has a tab. @param {string} name */
function choose(name) {
  tab.set(name);
  if (shape.value !== "wide") hidden.set({ ...hidden.value, side: false });
}

/** The tab that the list of problems has taken the place of. */
let covered = "joints";

/** Whether the list of problems lies over the view.
 * @type {Cell<boolean>} */
export const problemsOver = new Cell(/** @type {boolean} */ (false));

/** Show the list of problems, or hide it.
 * @param {boolean} on @param {boolean} [byItself] it then takes no room from the view */
export function showProblems(on, byItself = false) {
  problemsOver.set(on && byItself);
  if (shape.value === "wide") return hidden.set({ ...hidden.value, problems: !on });
  if (on && tab.value !== "problems") covered = tab.value;
  choose(on ? "problems" : covered);
}

/** What the menu Panels lists: a tab is shown when it is the chosen one.
 * @returns {{name: string, title: string, shown: boolean, toggle: () => void}[]} */
export function panelList() {
  const away = hidden.value;
  const has = (/** @type {string} */ name) => Boolean(rows.panels.get(name)?.length);
  const { displays, views, ...others } = SHEET;
  return Object.entries({ displays, views, ...others })
    .filter(([name]) => has(name))
    .map(([name, { title }]) => {
      const side = name in TABS ? "right" : name === "problems" ? "" : "left";
      const current = shownTab(name in TABS && shape.value === "wide" ? TABS : SHEET);
      const byTab = side === "right" || shape.value !== "wide";
      const folded = shape.value === "wide" ? away.right : shape.value === "flat" && away.side;
      const shown = byTab
        ? current === name && !folded
        : side
          ? !away.left && !away[name] && (name === "lesson" || !hasLesson() || Boolean(away.lesson))
          : away[name] === false;
      const toggle = () => {
        if (byTab && !shown) choose(name);
        if (shape.value === "wide")
          hidden.set({
            ...hidden.value,
            [name]: shown,
            ...(side && !shown ? { [side]: false, ...inFront(name) } : {}),
          });
      };
      return { name, title, shown, toggle };
    });
}

/** The names of the tabs that there are: none until all are known, so that none moves others away
 * while the page is loaded. @param {Record<string, any>} of */
export function tabNames(of) {
  if (!rows.isWhole) return [];
  return Object.keys(of).filter(
    (name) => rows.panels.get(name)?.length && !(shape.value === "wide" && hidden.value[name]),
  );
}

/** What is in front until somebody chooses: a lesson and the text to write, then pictures, which
 * RViz docks in sight, then joints; data, where there is no joint to move.
 * @param {Record<string, any>} of */
function firstTab(of) {
  if (hasLesson()) return of === TABS ? "model" : "lesson";
  if (rows.panels.get("images")?.length) return "images";
  return rows.get("joints/none") ? "topics" : "joints";
}

/** @param {Record<string, any>} of */
export function shownTab(of) {
  const names = tabNames(of);
  return [tab.value, firstTab(of), names[0]].find((name) => names.includes(name));
}

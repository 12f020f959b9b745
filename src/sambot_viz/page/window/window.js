// @ts-check
/* The window: toolbar, panels at the left, right and bottom, status bar. */

import { html, useEffect, useLayoutEffect, useRef } from "../vendor/preact.js";
import { rows } from "../wire/channel.js";
import { Connection } from "../wire/connection.js";
import { Dialogs } from "../dialogs/dialog.js";
import {
  hidden,
  room,
  shape,
  Splitter,
  togglePanels,
  useChosenViews,
  useSizes,
} from "./splitters.js";
import { DisplaysPanel } from "../panels/displays.js";
import { Driving } from "../panels/drive.js";
import { LessonPanel } from "../panels/lesson.js";
import { LiveDriving, StopRobot } from "../panels/live_drive.js";
import { ProblemCorner, ProblemsPanel } from "../panels/problems.js";
import { ViewsPanel } from "../panels/views.js";
import {
  hasLesson,
  inFront,
  panelList,
  problemsOver,
  SHEET,
  showProblems,
  shownTab,
  tab,
  tabNames,
  TABS,
} from "./panels.js";
import { Asking } from "./people.js";
import { openRecording } from "./files.js";
import { MarkerMenu } from "./marker_menu.js";
import { PlayerBar } from "./player_bar.js";
import { StatusBar } from "./status_bar.js";
import { Top } from "./header.js";
import { useRow } from "../state.js";
import { Part } from "./part.js";
import { Icon } from "./icons.js";

/** What tells that a part of the window has come. */
const PARTS = ["whole:session", "whole:browser"];

export function Window() {
  tab.use();
  const form = shape.use();
  const away = hidden.use();
  const size = useSizes();
  /** @type {Ref} */
  const view = useRef(null);
  useEffect(() => placeView(view.current), []);
  const style = Object.entries(size)
    .map(([side, px]) => `--${side}:${px}px`)
    .join(";");
  // In a narrow window the list would take the place of what is read, or written.
  const byHand = () => form !== "wide" && (hasLesson() || shownTab(SHEET) === "model");
  const listed = form === "wide" ? away.problems === false : tab.value === "problems" && !away.side;
  return html`<div class=${`window ${form}${away.all ? " bare" : ""}`} style=${style}>
    ${
      !away.all &&
      html`<${Part} title="The toolbar"><${Top} panels=${panelList} hideAll=${togglePanels} /><//>`
    }
    ${form === "wide" && !away.all && html`<${Left} />`}
    <div class="view" ref=${view}></div>
    ${away.all && html`<button class="back" onClick=${togglePanels}>Show panels (H)</button>`}
    ${
      away.all &&
      html`<${Driving} /><${LiveDriving} /><${ProblemCorner} show=${() => {
        togglePanels();
        showProblems(true);
      }} />`
    }
    ${form === "wide" && !away.all && html`<${Right} /><${Bottom} />`}
    ${form !== "wide" && !away.all && html`<${Sheet} />`}
    <${Part} title="The player"><${PlayerBar} openOther=${openRecording} /><//>
    ${
      !away.all &&
      html`<${Part} title="The status bar"><${StatusBar}
      problems=${{ shown: listed, show: showProblems, byItself: form !== "tall", byHand }} /><//>`
    }
    <${StopRobot} />
    <${Part} title="The menu"><${MarkerMenu} /><//>
    <div class="over-view"><${Asking} /><${Connection} /></div>
    <${Part} title="The dialog"><${Dialogs} /><//>
  </div>`;
}

/** Keep viser's page exactly where the view is. @param {HTMLElement} view */
function placeView(view) {
  const root = /** @type {HTMLElement} */ (document.getElementById("root"));
  root.setAttribute("role", "main");
  const place = () => {
    const { left, top, width, height } = view.getBoundingClientRect();
    Object.assign(root.style, {
      position: "fixed",
      left: `${left}px`,
      top: `${top}px`,
      width: `${width}px`,
      height: `${height}px`,
    });
  };
  const observer = new ResizeObserver(place);
  observer.observe(view);
  addEventListener("resize", place);
  place();
}

function Left() {
  const away = hidden.use();
  useRow("panel:views");
  useRow("panel:lesson");
  const lesson = hasLesson();
  const views = rows.children("panel:views").length > 0 && !away.views;
  const { views: height } = useSizes();
  const lower = useChosenViews() ? "lower" : "lower free";
  if (away.left || (away.displays && !views && !lesson)) return html`<${Tab} side="left" />`;
  if (lesson && !away.lesson)
    return html`<aside class="left" aria-label="Left panels"><${LessonOrOthers} />
      <${Part} title="Lesson"><${LessonPanel} /><//>
      <${Splitter} side="left" label="Width of the left panels" /></aside>`;
  return html`<aside class="left" aria-label="Left panels">
    ${lesson && html`<${LessonOrOthers} />`}
    ${!away.displays && html`<${Part} title="Displays"><${DisplaysPanel} /><//>`}
    ${
      views &&
      html`<div class=${lower} style=${`flex-basis:${height}px`}>
      <${Splitter} side="views" label="Height of Views" />
      <${Part} title="Views"><${ViewsPanel} /><//></div>`
    }
    <${Splitter} side="left" label="Width of the left panels" />
  </aside>`;
}

/** The tabs of the left panels, where there is a lesson. */
function LessonOrOthers() {
  const away = hidden.use();
  const chosen = away.lesson ? "displays" : "lesson";
  const choose = (/** @type {string} */ name) => () =>
    hidden.set({ ...hidden.value, [name]: false, ...inFront(name) });
  return html`<div class="tabs" role="tablist" aria-label="Left panels">
    ${["lesson", "displays"].map(
      (name) => html`<button role="tab" key=${name} aria-selected=${String(name === chosen)}
        onClick=${choose(name)}>${SHEET[name].title}</button>`,
    )}
  </div>`;
}

/** Draw again when another tab may be there. @param {Record<string, any>} of */
function useTabs(of) {
  tab.use();
  for (const name of [...Object.keys(of).map((name) => `panel:${name}`), ...PARTS]) useRow(name);
}

/** @param {{of: Record<string, {title: string, content: any}>, name: string}} props */
function Panel({ of, name }) {
  const { title, content } = of[name];
  return html`<${Part} key=${name} title=${title}><${content} /><//>`;
}

function Right() {
  const away = hidden.use();
  useTabs(TABS);
  const names = tabNames(TABS);
  const current = shownTab(TABS);
  const below = useBelow(names, current);
  if (away.right || !current) return html`<${Tab} side="right" />`;
  return html`<aside class="right" aria-label="Right panels">
    <${Tabs} names=${names} of=${TABS} current=${current} />
    <div class="content" role="tabpanel" id="panel-right" aria-label=${TABS[current].title}>
    <${Panel} of=${TABS} name=${current} /></div>
    ${
      below &&
      html`<section class="panel below" aria-label=${TABS[below].title}>
        <header class="title">${TABS[below].title}</header>
        <div class="content"><${Panel} of=${TABS} name=${below} /></div>
      </section>`
    }
    <${Splitter} side="right" label="Width of the right panels" />
  </aside>`;
}

/** A window as high as this has room for another panel below a few joints [px]. */
const HIGH = 800;
const FEW_JOINTS = 6;

/** The panel below Joints, where that would leave most of the column empty; in a component.
 * @param {string[]} names the tabs that there are @param {string} current the chosen one */
function useBelow(names, current) {
  const { height } = room.use();
  const joints = rows.panels.get("joints") || [];
  const fits = height >= HIGH && current === "joints" && joints.length <= FEW_JOINTS;
  return fits ? ["images", "drive", "frames"].find((name) => names.includes(name)) : undefined;
}

function Sheet() {
  const beside = shape.use() === "flat";
  const away = hidden.use();
  /** @type {Record<string, {title: string, content: any}>} */
  const of = SHEET;
  useTabs(of);
  const names = tabNames(of);
  const current = shownTab(of) || "joints";
  if (beside && away.side) return html`<${Tab} side="side" />`;
  return html`<aside class="sheet" aria-label="Panels">
    <${Tabs} names=${names} of=${of} current=${current} />
    <div class="content" role="tabpanel" id="panel-right" aria-label=${of[current].title}>
    <${Panel} of=${of} name=${current} /></div>
    ${beside && html`<${Splitter} side="side" label="Width of the panels" />`}
  </aside>`;
}

/** More tabs than these have short names, so that they fit into a line. */
const FEW = 6;

/** Give tabs that do not fit into a line two lines, where all can be read. @param {HTMLElement} tabs */
function wrapTabs(tabs) {
  tabs.classList.remove("two");
  tabs.classList.toggle("two", tabs.scrollWidth > tabs.clientWidth);
}

/**
 * @param {{names: string[], of: Record<string, {title: string, short?: string}>, current: string}}
 *   props
 */
function Tabs({ names, of, current }) {
  /** @param {Key} event */
  const key = (event) => {
    const by = /** @type {Record<string, number>} */ ({ ArrowRight: 1, ArrowLeft: -1 })[event.key];
    if (!by) return;
    const next = names[(names.indexOf(current) + by + names.length) % names.length];
    tab.set(next);
    event.currentTarget.querySelector(`[data-tab="${next}"]`)?.focus();
    event.preventDefault();
    event.stopPropagation();
  };
  /** @type {Ref} */
  const element = useRef(null);
  const wrap = () => wrapTabs(element.current);
  useLayoutEffect(wrap);
  useLayoutEffect(() => {
    const observer = new ResizeObserver(wrap);
    observer.observe(element.current);
    return () => observer.disconnect();
  }, []);
  return html`<div class="tabs" role="tablist" ref=${element} onKeyDown=${key}
    style=${`--half: ${Math.ceil(names.length / 2)}`}>
    ${names.map(
      (name) => html`<button role="tab" key=${name} data-tab=${name}
        aria-selected=${String(name === current)}
      aria-controls=${name === current ? "panel-right" : undefined}
        tabindex=${name === current ? 0 : -1}
      aria-label=${of[name].title} title=${of[name].title} onClick=${() => tab.set(name)}>
        ${((of !== TABS || names.length > FEW) && of[name].short) || of[name].title}</button>`,
    )}
  </div>`;
}

/** What is below the view: the problems, when they are open. */
function Bottom() {
  const away = hidden.use();
  const over = problemsOver.use() ? " over" : "";
  if (away.problems !== false) return null;
  return html`<section class=${`panel bottom${over}`} aria-label="Problems">
    <${Splitter} side="bottom" label="Height of Problems" />
    <header class="title">Problems
      <button class="flat" aria-label="Close Problems" title="Close"
        onClick=${() => hidden.set({ ...away, problems: true })}><${Icon} name="close" /></button>
    </header>
    <${Part} title="Problems"><${ProblemsPanel} /><//>
  </section>`;
}

/** @param {{side: string}} props */
function Tab({ side }) {
  const words = side === "side" ? "Show the panels" : `Show the ${side} panels`;
  return html`<button class=${`unfold ${side}`} title=${words} aria-label=${words}
    onClick=${() => unfoldSide(side)}><${Icon} name=${side === "left" ? "unfold" : "fold"} />
      </button>`;
}

/**
 * Show the panels of a side again; when each was hidden by itself, all of them.
 * @param {string} side
 */
function unfoldSide(side) {
  const names = side === "left" ? ["displays", "views"] : side === "right" ? Object.keys(TABS) : [];
  const next = { ...hidden.value, [side]: false };
  if (names.every((name) => next[name] || !rows.panels.get(name)?.length))
    for (const name of names) delete next[name];
  hidden.set(next);
}

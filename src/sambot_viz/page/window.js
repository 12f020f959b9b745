// @ts-check
/* The window: toolbar, panels at the left, right and bottom, status bar. */

import { html, useEffect, useLayoutEffect, useRef } from "./vendor/preact.js";
import { rows } from "./channel.js";
import { Connection } from "./connection.js";
import { Dialogs } from "./dialogs/dialog.js";
import { FileName } from "./files.js";
import { MenuBar } from "./menus.js";
import { DisplaysPanel } from "./panels/displays.js";
import { FramesPanel } from "./panels/frames.js";
import { DrivePanel, Driving } from "./panels/drive.js";
import { JointsPanel } from "./panels/joints.js";
import { ProblemCorner, ProblemsPanel } from "./panels/problems.js";
import { ViewsPanel } from "./panels/views.js";
import { StatusBar } from "./status_bar.js";
import { Toolbar } from "./toolbar.js";
import { Tree } from "./tree.js";
import { Cell, useRow } from "./state.js";
import { Icon } from "./icons.js";

/** On a tablet the view has half of the window. */
const small = innerWidth < 1150;
/** Sizes of the panels [px]. @type {Cell<Record<string, number>>} */
const sizes = new Cell({ left: small ? 236 : 300, right: small ? 268 : 320, bottom: 210, views: 240 }, "sizes");
/** Which panels are folded away. @type {Cell<Record<string, boolean>>} */
export const hidden = new Cell(/** @type {Record<string, boolean>} */ ({}), "hidden");
/** The chosen tab at the right, or in the sheet of a phone. */
export const tab = new Cell("joints", "tab");
/** "wide" beside the view, "tall" (a phone) below it. */
export const shape = new Cell(measure());

function measure() {
  return matchMedia("(max-width: 640px) and (orientation: portrait)").matches ? "tall"
    : matchMedia("(max-height: 480px), (max-width: 640px)").matches ? "flat" : "wide";
}
addEventListener("resize", () => shape.set(measure()));

/**
 * The panels that are chosen by tabs; a new one is a file and a line here.
 * @type {Record<string, {title: string, content: any}>}
 */
const TABS = {
  joints: { title: "Joints", content: JointsPanel },
  frames: { title: "Frames", content: FramesPanel },
  selection: { title: "Selection", content: () => html`<${Tree} panel="selection" label="Selection" />` },
  drive: { title: "Drive", content: DrivePanel },
  tool_properties: { title: "Tool Properties", content: () => html`<${Tree} panel="tool_properties" label="Tool Properties" />` },
};
const SHEET = {
  ...TABS,
  displays: { title: "Displays", content: DisplaysPanel },
  views: { title: "Views", content: ViewsPanel },
  problems: { title: "Problems", content: ProblemsPanel },
};

/** Hide all panels, or bring them back. */
export function togglePanels() { hidden.set({ ...hidden.value, all: !hidden.value.all }); }

/** Show the list of problems, or hide it. @param {boolean} on */
function showProblems(on) {
  if (shape.value === "wide") hidden.set({ ...hidden.value, problems: !on });
  else tab.set(on ? "problems" : "joints");
}

/** What the menu Panels lists: a tab is shown when it is the chosen one.
 * @returns {{name: string, title: string, shown: boolean, toggle: () => void}[]} */
function panelList() {
  const away = hidden.value;
  const has = (/** @type {string} */ name) => Boolean(rows.panels.get(name)?.length);
  const { displays, views, ...others } = SHEET;
  return Object.entries({ displays, views, ...others }).filter(([name]) => has(name)).map(([name, { title }]) => {
    const side = name in TABS ? "right" : name === "problems" ? "" : "left";
    const current = shownTab(name in TABS && shape.value === "wide" ? TABS : SHEET);
    const byTab = side === "right" || shape.value !== "wide";
    const shown = byTab ? current === name && !(shape.value === "wide" && away.right)
      : side ? !away.left && !away[name] : away[name] === false;
    const toggle = () => {
      if (byTab && !shown) tab.set(name);
      if (shape.value === "wide") hidden.set({ ...away, [name]: shown, ...(side && !shown ? { [side]: false } : {}) });
    };
    return { name, title, shown, toggle };
  });
}

/** The names of the tabs that there are. @param {Record<string, any>} of */
function tabNames(of) {
  return Object.keys(of).filter((name) => rows.panels.get(name)?.length && !(shape.value === "wide" && hidden.value[name]));
}

/** @param {Record<string, any>} of */
function shownTab(of) {
  const names = tabNames(of);
  return names.includes(tab.value) ? tab.value : names[0];
}

export function Window() {
  tab.use();
  const form = shape.use(), away = hidden.use(), size = sizes.use();
  const view = useRef(/** @type {any} */ (null));
  useEffect(() => placeView(view.current), []);
  const style = `--left:${size.left}px;--right:${size.right}px;--bottom:${size.bottom}px`;
  return html`<div class=${`window ${form}${away.all ? " bare" : ""}`} style=${style}>
    ${!away.all && html`<div class="top">
      <${MenuBar} panels=${panelList} hideAll=${togglePanels} small=${form !== "wide"} /><${Toolbar} /><${FileName} />
    </div>`}
    ${form === "wide" && !away.all && html`<${Left} />`}
    <div class="view" ref=${view}></div>
    ${away.all && html`<button class="back" onClick=${togglePanels}>Show panels (H)</button>`}
    ${away.all && html`<${Driving} /><${ProblemCorner} show=${() => { togglePanels(); showProblems(true); }} />`}
    ${form === "wide" && !away.all && html`<${Right} /><${Bottom} />`}
    ${form !== "wide" && !away.all && html`<${Sheet} />`}
    ${!away.all && html`<${StatusBar} problems=${{ shown: form === "wide" ? away.problems === false : tab.value === "problems", show: showProblems, byItself: form === "wide" }} />`}
    <${Connection} />
    <${Dialogs} />
  </div>`;
}

/** Keep viser's page exactly where the view is. @param {HTMLElement} view */
function placeView(view) {
  const root = /** @type {HTMLElement} */ (document.getElementById("root"));
  const place = () => {
    const { left, top, width, height } = view.getBoundingClientRect();
    Object.assign(root.style, { position: "fixed", left: `${left}px`, top: `${top}px`,
      width: `${width}px`, height: `${height}px` });
  };
  const observer = new ResizeObserver(place);
  observer.observe(view);
  addEventListener("resize", place);
  place();
}

/** @param {{title: string, name: string, children?: any}} props */
export function Section({ title, name, children }) {
  const away = hidden.use();
  return html`<section class=${`panel ${name}`} aria-label=${title}>
    <header class="title">${title}
      <button class="flat" title=${`Fold ${title}`} aria-label=${`Fold ${title}`}
        onClick=${() => hidden.set({ ...away, [name]: true })}><${Icon} name="close" /></button>
    </header>${children}</section>`;
}

function Left() {
  const away = hidden.use();
  useRow("panel:views");
  const views = rows.children("panel:views").length > 0 && !away.views;
  if (away.left || (away.displays && !views)) return html`<${Tab} side="left" />`;
  return html`<aside class="left">
    ${!away.displays && html`<${DisplaysPanel} />`}
    ${views && html`<div class="lower" style=${`height:${sizes.value.views}px`}>
      <${Splitter} side="views" label="Height of Views" /><${ViewsPanel} /></div>`}
    <${Splitter} side="left" label="Width of the left panels" />
  </aside>`;
}

function Right() {
  const away = hidden.use();
  tab.use();
  for (const name of Object.keys(TABS)) useRow(`panel:${name}`);
  const names = tabNames(TABS), current = shownTab(TABS);
  if (away.right || !current) return html`<${Tab} side="right" />`;
  return html`<aside class="right">
    <${Tabs} names=${names} of=${TABS} current=${current} />
    <div class="content" role="tabpanel" id="panel-right" aria-label=${TABS[current].title}><${TABS[current].content} /></div>
    <${Splitter} side="right" label="Width of the right panels" />
  </aside>`;
}

function Sheet() {
  tab.use();
  /** @type {Record<string, {title: string, content: any}>} */
  const of = SHEET;
  for (const name of Object.keys(of)) useRow(`panel:${name}`);
  const names = tabNames(of), current = shownTab(of) || "joints";
  return html`<aside class="sheet">
    <${Tabs} names=${names} of=${of} current=${current} />
    <div class="content" role="tabpanel" id="panel-right" aria-label=${of[current].title}><${of[current].content} /></div>
  </aside>`;
}

/** How much of the tabs fades where there are more beyond the edge [px]. */
const EDGE = 32;

/** Fade the ends of a strip beyond which there is more. @param {HTMLElement} strip */
function fadeEdges(strip) {
  const rest = strip.scrollWidth - strip.clientWidth - strip.scrollLeft;
  strip.style.setProperty("--before", `${Math.min(EDGE, strip.scrollLeft)}px`);
  strip.style.setProperty("--after", `${Math.max(0, Math.min(EDGE, rest))}px`);
}

/** @param {{names: string[], of: Record<string, {title: string}>, current: string}} props */
function Tabs({ names, of, current }) {
  /** @param {any} event */
  const key = (event) => {
    const by = /** @type {Record<string, number>} */ ({ ArrowRight: 1, ArrowLeft: -1 })[event.key];
    if (!by) return;
    const next = names[(names.indexOf(current) + by + names.length) % names.length];
    tab.set(next);
    event.currentTarget.querySelector(`[data-tab="${next}"]`)?.focus();
    event.preventDefault();
    event.stopPropagation();
  };
  const element = useRef(/** @type {any} */ (null));
  const fade = () => fadeEdges(element.current);
  // The chosen tab is in sight, and so is that there are others beside it.
  useLayoutEffect(() => {
    const strip = element.current, { left, right } = strip.getBoundingClientRect();
    const chosen = strip.querySelector("[aria-selected=true]")?.getBoundingClientRect();
    if (chosen?.left < left + EDGE) strip.scrollLeft -= left + EDGE - chosen.left;
    if (chosen?.right > right - EDGE) strip.scrollLeft += chosen.right - right + EDGE;
  }, [current]);
  useLayoutEffect(fade);
  useLayoutEffect(() => {
    const observer = new ResizeObserver(fade);
    observer.observe(element.current);
    return () => observer.disconnect();
  }, []);
  return html`<div class="tabs" role="tablist" ref=${element} onKeyDown=${key} onScroll=${fade}>
    ${names.map((name) => html`<button role="tab" key=${name} data-tab=${name} aria-selected=${String(name === current)}
      aria-controls=${name === current ? "panel-right" : undefined} tabindex=${name === current ? 0 : -1}
      onClick=${() => tab.set(name)}>${of[name].title}</button>`)}
  </div>`;
}

/** What is below the view: the problems, when they are open. */
function Bottom() {
  const away = hidden.use();
  if (away.problems !== false) return null;
  return html`<section class="panel bottom" aria-label="Problems">
    <${Splitter} side="bottom" label="Height of Problems" />
    <header class="title">Problems
      <button class="flat" aria-label="Close Problems" title="Close" onClick=${() => hidden.set({ ...away, problems: true })}><${Icon} name="close" /></button>
    </header>
    <${ProblemsPanel} />
  </section>`;
}

/** @param {{side: string}} props */
function Tab({ side }) {
  return html`<button class=${`unfold ${side}`} title=${`Show the ${side} panels`} aria-label=${`Show the ${side} panels`}
    onClick=${() => unfoldSide(side)}><${Icon} name=${side === "left" ? "unfold" : "fold"} /></button>`;
}

/** Show the panels of a side again; when each was hidden by itself, all of them. @param {string} side */
function unfoldSide(side) {
  const names = side === "left" ? ["displays", "views"] : Object.keys(TABS);
  const next = { ...hidden.value, [side]: false };
  if (names.every((name) => next[name] || !rows.panels.get(name)?.length)) for (const name of names) delete next[name];
  hidden.set(next);
}

/** An edge that a hand can move; arrow keys move it too. @param {{side: string, label: string}} props */
function Splitter({ side, label }) {
  const sign = side === "left" ? 1 : -1;
  const across = side === "left" || side === "right";
  const most = () => (across ? innerWidth : innerHeight) * 0.6;
  /** @param {number} size */
  const set = (size) => sizes.set({ ...sizes.value, [side]: Math.round(Math.min(most(), Math.max(90, size))) });
  /** @param {any} event */
  const drag = (event) => {
    const from = across ? event.clientX : event.clientY, size = sizes.value[side];
    event.target.setPointerCapture(event.pointerId);
    event.target.onpointermove = (/** @type {any} */ e) => set(size + sign * ((across ? e.clientX : e.clientY) - from));
    event.target.onpointerup = () => { event.target.onpointermove = null; };
    event.preventDefault();
  };
  /** @param {any} event */
  const key = (event) => {
    const by = /** @type {Record<string, number>} */ ({ ArrowRight: 16, ArrowUp: across ? 0 : -16, ArrowLeft: -16, ArrowDown: across ? 0 : 16 })[event.key];
    if (!by) return;
    set(sizes.value[side] + sign * by);
    event.preventDefault();
    event.stopPropagation();
  };
  const icon = across && html`<button class="tuck" tabindex="-1" aria-label=${`Hide the ${side} panels`} title=${`Hide the ${side} panels`}
    onClick=${() => hidden.set({ ...hidden.value, [side]: true })}><${Icon} name=${side === "left" ? "fold" : "unfold"} /></button>`;
  return html`<div class=${`splitter ${across ? "across" : "down"} ${side}`}><div class="grip" role="separator" tabindex="0" aria-label=${label}
    aria-orientation=${across ? "vertical" : "horizontal"} aria-valuenow=${sizes.value[side]} aria-valuemin="90" aria-valuemax=${Math.round(most())}
    onPointerDown=${drag} onKeyDown=${key}></div>${icon}</div>`;
}

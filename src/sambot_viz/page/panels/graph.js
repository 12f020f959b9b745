// @ts-check
/* The Graph panel: nodes and topics, placed by the server, as rqt_graph draws them. */

import { html, useEffect, useRef } from "../vendor/preact.js";
import { act, rows } from "../wire/channel.js";
import { ValueCell } from "../cells/cells.js";
import { Dialog, show } from "../dialogs/dialog.js";
import { Cell, useData, useRow, wantedRow } from "../state.js";
import { copy } from "../window/clipboard.js";
import { nearestPart } from "./graph_steps.js";

/**
 * @typedef {{kind: string, name: string, box: [number, number, number, number], lines: string[],
 *   look: string, said: string, place: string, problem: string}} Part
 * @typedef {{width: number, height: number, spaces: [number, number, number, number, string][],
 *   edges: [string, string, string][], parts: Part[]}} Picture
 */

const LINE = 13;
/** How large the picture is drawn in the panel and over the whole window; 0 fits its width as far as
 * it can be read. @typedef {Cell<number>} Zoom */
const zooms = { panel: new Cell(0, "graph-zoom"), large: new Cell(0, "graph-zoom-large") };
const [SMALLEST, LARGEST, STEP] = [0.1, 3, 1.25];
const READABLE = 0.85;
/** The part that was chosen last. @type {Cell<string>} */
const chosen = new Cell("");

/** @param {Part} part */
const keyOf = (part) => `${part.kind} ${part.name}`;

export function GraphPanel() {
  const shown = useData("graph/shown");
  // It is made only while somebody can see it.
  useEffect(() => {
    if (shown === false) act("graph/show", [true]);
  }, [shown]);
  useEffect(() => () => act("graph/show", [false]), []);
  return html`<div class="graph">
    <${Facts} />
    <${Drawing} zoom=${zooms.panel} />
    <div class="buttons">
      <${Controls} zoom=${zooms.panel} />
      <button title="Show the graph over the whole window" onClick=${() => show(LargeGraph)}>
        Enlarge</button>
    </div>
  </div>`;
}

/** @param {{close: () => void}} props */
function LargeGraph({ close }) {
  // What a part leads to is under the dialog.
  useEffect(() => {
    wantedRow.listeners.add(close);
    return () => {
      wantedRow.listeners.delete(close);
    };
  }, []);
  return html`<${Dialog} title="Nodes and topics" close=${close} look="graph-dialog">
    <div class="graph"><${Facts} /><${Drawing} zoom=${zooms.large} /></div>
    <div class="buttons"><${Controls} zoom=${zooms.large} />
      <button type="button" onClick=${close}>Close</button></div>
  </${Dialog}>`;
}

/** The size of the picture nearest to a button. @param {Event} event */
function drawnBeside(event) {
  const around = /** @type {Element} */ (event.currentTarget).closest(".graph, form");
  const drawn = around?.querySelector("svg.ros-graph");
  if (!(drawn instanceof SVGSVGElement) || !drawn.parentElement) return null;
  const { width, height } = drawn.viewBox.baseVal;
  return { drawn, width, height, room: drawn.parentElement };
}

/** How the picture is drawn. @param {{zoom: Zoom}} props */
function Controls({ zoom }) {
  const details = useRow("graph/details");
  /** @param {number} by */
  const change = (by) => (/** @type {Event} */ event) => {
    const beside = drawnBeside(event);
    if (!beside) return;
    const now = beside.drawn.clientWidth / beside.width;
    zoom.set(Math.min(LARGEST, Math.max(SMALLEST, now * by)));
  };
  /** @param {Event} event */
  const fit = (event) => {
    const beside = drawnBeside(event);
    if (!beside) return;
    const { width, height, room } = beside;
    // A scroll bar that goes leaves more room.
    const scale = Math.min(room.clientWidth / width, room.clientHeight / height, 1);
    zoom.set(Math.max(SMALLEST, scale));
  };
  return html`
    <button type="button" title="Draw the graph larger" aria-label="Larger"
      onClick=${change(STEP)}>+</button>
    <button type="button" title="Draw the graph smaller" aria-label="Smaller"
      onClick=${change(1 / STEP)}>−</button>
    <button type="button" title="Show the whole graph" onClick=${fit}>Fit</button>
    ${
      details &&
      html`<span class="beside" title=${details.help}>
        <${ValueCell} row=${details} tab=${0} /><span aria-hidden="true">${details.name}</span></span>`
    }`;
}

/** The choice of a launch file, and what is left out. */
function Facts() {
  useRow("panel:graph");
  const launch = useRow("graph/launch");
  const notes = (rows.panels.get("graph") || [])
    .map((id) => rows.get(id))
    .filter((row) => row?.kind === "note");
  return html`${
    launch &&
    html`<label class="above"><span>${launch.name}</span> <${ValueCell} row=${launch} tab=${0} /></label>`
  }
    ${notes.map((row) => html`<p key=${row?.id} class="note">${row?.value}</p>`)}`;
}

/** The picture, and what the chosen part says. @param {{zoom: Zoom}} props */
function Drawing({ zoom }) {
  /** @type {Picture | null} */
  const picture = useData("graph/picture");
  const now = zoom.use();
  const key = chosen.use();
  /** @type {Ref<SVGSVGElement>} */
  const element = useRef(null);
  const launch = useRow("graph/launch")?.value;
  const isThere = Boolean(picture?.parts.length);
  // It begins where something is wrong.
  useEffect(() => {
    const wrong = element.current?.querySelector(".part.error, .part.warning");
    wrong?.scrollIntoView({ block: "center", inline: "center" });
  }, [isThere, launch]);
  if (!picture?.parts.length) return null;
  const { width, height, parts } = picture;
  const at = Math.max(
    0,
    parts.findIndex((part) => keyOf(part) === key),
  );
  /** @param {number} i */
  const go = (i) => {
    if (i < 0) return;
    chosen.set(keyOf(parts[i]));
    const drawn = element.current.querySelectorAll(".part")[i];
    if (drawn instanceof SVGElement) drawn.focus();
    drawn?.scrollIntoView({ block: "nearest", inline: "nearest" });
  };
  /** @param {KeyboardEvent} event */
  const press = (event) => {
    const next = nearestPart(parts, at, event.key);
    if (event.key === "Enter" || event.key === " ") lead(parts[at]);
    else if (next >= 0) go(next);
    else if (!event.key.startsWith("Arrow")) return;
    event.preventDefault();
    event.stopPropagation();
  };
  const scaled = now ? `${width * now}px` : `clamp(${READABLE * width}px, 100%, ${width}px)`;
  const size = `width: ${scaled}; aspect-ratio: ${width} / ${height}`;
  return html`<div class="picture">
      <svg ref=${element} class="ros-graph" viewBox=${`0 0 ${width} ${height}`} style=${size}
        role="group" aria-label="Nodes and topics" onKeyDown=${press}>
        <marker id="graph-arrow" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="7"
          markerHeight="7" orient="auto"><path d="M0 0L8 4L0 8z" /></marker>
        ${picture.spaces.map(
          ([x, y, w, h, name]) =>
            html`<g class="space" key=${name}><rect x=${x} y=${y} width=${w} height=${h} rx="8" />
              <text x=${x + 8} y=${y + 16}>${name}</text></g>`,
        )}
        ${picture.edges.map(
          ([path, look, said]) =>
            html`<path key=${said} class=${look} d=${path}
              marker-end="url(#graph-arrow)"><title>${said}</title></path>`,
        )}
        ${parts.map(
          (part, i) =>
            html`<${PartView} key=${keyOf(part)} part=${part} tab=${i === at ? 0 : -1}
              isChosen=${keyOf(part) === key} />`,
        )}
      </svg>
    </div>
    ${keyOf(parts[at]) === key && html`<${Said} part=${parts[at]} />`}`;
}

/** @param {{part: Part, tab: number, isChosen: boolean}} props */
function PartView({ part, tab, isChosen }) {
  const [x, y, w, h] = part.box;
  const top = y - (LINE * (part.lines.length - 1)) / 2 + 4.5;
  const last = part.look.match(/error|warning|info/) ? part.lines.length - 1 : -1;
  const shape =
    part.kind === "node"
      ? html`<ellipse class="shape" cx=${x} cy=${y} rx=${w / 2} ry=${h / 2} />`
      : html`<rect class="shape" x=${x - w / 2} y=${y - h / 2} width=${w} height=${h} rx="3" />`;
  const press = () => {
    chosen.set(keyOf(part));
    lead(part);
  };
  return html`<g class=${`part ${part.look} ${isChosen ? "chosen" : ""}`} role="button"
    tabindex=${tab} aria-label=${keyOf(part)} onClick=${press}
    onFocus=${() => chosen.set(keyOf(part))}><title>${part.said}</title>${shape}
    ${part.lines.map(
      (line, i) =>
        html`<text class=${i ? (i === last ? "small problem" : "small") : ""} x=${x}
          y=${top + LINE * i}>${line}</text>`,
    )}</g>`;
}

/** The row of a topic, where there is one: its panel has them only while it is shown.
 * @param {Part} part */
const topicRow = (part) =>
  part.kind === "topic" && rows.panels.get("topics")?.length ? `topic:${part.name}` : "";

/** Go to what is wrong with a part, or to the row of a topic. @param {Part} part */
function lead(part) {
  const topic = topicRow(part);
  if (part.problem) wantedRow.set({ panel: "problems", id: part.problem });
  else if (topic) wantedRow.set({ panel: "topics", id: topic });
}

/** What a part says, with what can be done. @param {{part: Part}} props */
function Said({ part }) {
  const topic = topicRow(part);
  return html`<div class="said">
    ${part.said.split("\n").map((line, i) => html`<p key=${i}>${line}</p>`)}
    <div class="buttons">
      ${
        part.place &&
        html`<button type="button" title=${part.place}
          onClick=${() => copy(part.place, `Copied ${part.place}`)}>Copy file and line</button>`
      }
      ${
        part.problem &&
        html`<button type="button"
          onClick=${() => wantedRow.set({ panel: "problems", id: part.problem })}>
          Show in Problems</button>`
      }
      ${
        topic &&
        html`<button type="button"
          onClick=${() => wantedRow.set({ panel: "topics", id: topic })}>Show in Topics</button>`
      }
    </div>
  </div>`;
}

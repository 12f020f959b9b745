// @ts-check
/* The Compare panel: a model to compare the robot with, and what differs. */

import { html, useRef, useState } from "../vendor/preact.js";
import { useAfter, useData, useRow, wantedRow } from "../state.js";
import { Tree } from "../tree/tree.js";
import { glow } from "../view/drawn_here.js";
import { act, rows } from "../wire/channel.js";

/**
 * @typedef {{whose: string, what: string, mine: string, theirs: string, apart: string,
 *   places: string, link: string, node: string}} Difference places: where both values are written;
 *   link: of the robot, "" where it lacks it; node: of the link in the view
 */

const HEADS = ["What", "Mine", "Theirs", "Apart"];

/** Light the link of a difference, or none. @param {Difference} [of] */
const light = (of) => glow(of?.node ? [of.node, 0, 0, 0] : undefined);

/** Open the text of a link, where there is one. @param {Difference} of */
function write({ link }) {
  if (!link || !rows.panels.get("model")?.length) return;
  wantedRow.set({ panel: "model", id: "model/note" });
  act("model/find", [link]);
}

export function ComparePanel() {
  useRow("panel:compare");
  /** @type {Difference[]} */
  const found = useData("compare/found") || [];
  return html`<div class="compare">
    <${Tree} panel="compare" label="Compare" />
    ${found.length > 0 && html`<${Table} found=${found} />`}
  </div>`;
}

/** @param {{found: Difference[]}} props */
function Table({ found }) {
  const [chosen, setChosen] = useState(-1);
  /** @type {Ref} */
  const body = useRef(null);
  useAfter(() => () => light(), []);
  /** @param {number} at */
  const choose = (at) => {
    setChosen(at);
    light(found[at]);
  };
  /** @param {KeyboardEvent} event @param {number} at */
  const key = (event, at) => {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (event.key === "Enter") return write(found[at]);
    if (!step) return undefined;
    event.preventDefault();
    return body.current.querySelectorAll("tr")[at + step]?.focus();
  };
  const stop = Math.min(Math.max(0, chosen), found.length - 1);
  /** @param {Difference} one @param {number} at */
  const row = (one, at) => html`<tr key=${`${one.whose} ${one.what}`} title=${one.places}
    tabindex=${at === stop ? 0 : -1} aria-selected=${String(at === chosen)}
    onFocus=${() => choose(at)} onClick=${() => choose(at)} onDblClick=${() => write(one)}
    onPointerEnter=${() => light(one)} onPointerLeave=${() => light(found[chosen])}
    onKeyDown=${(/** @type {KeyboardEvent} */ event) => key(event, at)}>
    <th scope="row">${one.whose || "robot"}${one.what && html` <small>${one.what}</small>`}</th>
    <td>${one.mine}</td><td>${one.theirs}</td><td>${one.apart}</td></tr>`;
  return html`<div class="differences">
    <table role="grid" aria-label="What differs">
      <thead><tr>${HEADS.map((name) => html`<th>${name}</th>`)}</tr></thead>
      <tbody ref=${body}>${found.map(row)}</tbody>
    </table></div>`;
}

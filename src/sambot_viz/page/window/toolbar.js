// @ts-check
/* The toolbar: RViz's tools as icon and word, what moves the view, undo and redo. */

import { html, useEffect, useState } from "../vendor/preact.js";
import { act, rows } from "../wire/channel.js";
import { actAtOnce, newTool } from "../view/new_tool.js";
import { Icon } from "./icons.js";
import { focusView } from "../view/pointer.js";
import { useData } from "../state.js";
import { togglePanels } from "./splitters.js";

/** The keys of the tools. @returns {{name: string, key: string}[]} */
export function toolKeys() {
  return rows.data("tools/list") || [];
}

/** Tell the script that draws whether the controls of interactive markers are visible. */
export function tellControls() {
  const told = () => {
    window.sambotViz = { ...window.sambotViz, controls: rows.data("tools/controls") };
    window.__viserMutable?.requestRender?.();
  };
  rows.listen("tools/controls", told);
  told();
}

/** @typedef {{name: string, key: string, help: string, current: boolean, hover: boolean}} Tool */

/** What the commands for edits are called. */
export const EDITS = { undo: "Undo", redo: "Redo" };

export function Toolbar() {
  /** @type {Tool[]} */
  const tools = useData("tools/list") || [];
  const chosen = newTool.use();
  return html`<div class="toolbar" role="toolbar" aria-label="Tools" onKeyDown=${move}>
    ${tools.map(
      (tool) => html`<${ToolButton} key=${tool.name} tool=${tool}
      on=${chosen === null ? tool.current : chosen === tool.name} />`,
    )}
    <span class="rule"></span>
    <${Button} icon="focus" name="Focus" keys="F"
      help="Look at the selection, or at the whole robot if nothing is selected."
      onClick=${() => act("tools/focus", [null, null])} />
    <span class="gap"></span>
    <${EditButton} id="undo" keys="Ctrl+Z" />
    <${EditButton} id="redo" keys="Ctrl+Shift+Z" />
    <${FullScreen} />
    <${Button} icon="hide" name="Hide panels" keys="H"
      help="The view fills the window; H shows the panels again." bare
      onClick=${togglePanels} />
  </div>`;
}

/** Arrow keys go from button to button. @param {Key} event */
function move(event) {
  const by = /** @type {Record<string, number>} */ ({ ArrowRight: 1, ArrowLeft: -1 })[event.key];
  if (!by || !event.target.matches("button")) return;
  const buttons = [...event.currentTarget.querySelectorAll("button:enabled")];
  buttons[(buttons.indexOf(event.target) + by + buttons.length) % buttons.length].focus();
  event.preventDefault();
  event.stopPropagation();
}

/** @param {{tool: Tool, on: boolean}} props */
function ToolButton({ tool: { name, key, help }, on }) {
  return html`<button class="tool" aria-label=${name} aria-pressed=${String(on)}
    aria-keyshortcuts=${key.toUpperCase()} title=${`${name} (${key.toUpperCase()}): ${help}`}
    onClick=${(/** @type {MouseEvent} */ e) => {
      actAtOnce("tools/choose", [name]);
      // Who came with the mouse goes on in the view; who came by keys stays in the toolbar.
      if (e.detail) focusView();
    }}><${Icon} name=${name} /> <span class="word">${name}
      </span></button>`;
}

/**
 * @param {{icon: string, name: string, keys: string, help: string, bare?: boolean,
 *   onClick: () => void}} props
 *   bare: without its word, and on a phone only in the menu */
function Button({ icon, name, keys, help, bare, onClick }) {
  return html`<button class=${bare ? "tool rare" : "tool view-button"} aria-label=${name}
    aria-keyshortcuts=${keys} title=${`${name} (${keys}): ${help}`}
    onClick=${onClick}><${Icon} name=${icon} />${!bare && html` <span class="word">${name}</span>`}
      </button>`;
}

/** @param {{id: "undo" | "redo", keys: string}} props */
function EditButton({ id, keys }) {
  const label = useData("edit/labels")?.[id],
    name = EDITS[id];
  return html`<button class="tool rare" disabled=${!label}
    title=${label ? `${name}: ${label} (${keys})` : `${name} (${keys})`} aria-label=${name}
    aria-keyshortcuts=${keys.replace("Ctrl", "Control")} onClick=${() => act(`edit/${id}`)}>
      <${Icon} name=${id} /></button>`;
}

export function toggleFullScreen() {
  if (document.fullscreenElement) document.exitFullscreen();
  else document.documentElement.requestFullscreen?.().catch(() => undefined);
}

function FullScreen() {
  const [full, setFull] = useState(false);
  useEffect(() => {
    const changed = () => setFull(Boolean(document.fullscreenElement));
    document.addEventListener("fullscreenchange", changed);
    return () => document.removeEventListener("fullscreenchange", changed);
  }, []);
  return html`<button class="tool" aria-label="Full screen" aria-pressed=${String(full)}
    title="Full screen: use the whole screen; Esc leaves it" onClick=${toggleFullScreen}>
      <${Icon} name="full" /></button>`;
}

// @ts-check
/* Go to…: one list of all displays, joints, frames and commands, found by a few letters. */

import { html, useLayoutEffect, useMemo, useRef, useState } from "../vendor/preact.js";
import { Dialog, leaveFor, show } from "../dialogs/dialog.js";
import { fold } from "../state.js";
import { matches, namesAbove } from "../tree/search.js";
import { reveal } from "../tree/tree.js";
import { rows } from "../wire/channel.js";
import { actAtOnce } from "../view/new_tool.js";
import { takeTyped } from "./files.js";
import { hiddenButtons, shownButtons } from "./buttons.js";
import { Icon } from "./icons.js";
import { listMenus } from "./menus.js";
import { openPanel, panelList, SHEET } from "./panels.js";
import { togglePanels } from "./splitters.js";
import { toggleFullScreen } from "./toolbar.js";

/** @typedef {{kind: string, icon: string, name: string, where: string, keys?: string,
 *   words?: string, does: () => void}} Target words: more by which it is found */

/** Maximum number of listed results; more letters find the others. */
const MOST = 60;
/** What PageUp and PageDown pass over. */
const FAR = 8;

/** What can be done also while its button is not on the screen. @returns {Target[]} */
function calls() {
  /** @type {[string, string, string, string, any[]?, string?][]} */
  const all = [
    ["Focus", "View", "focus", "tools/focus", [null, null], "F"],
    ["Zero", "View", "zero", "tools/zero", [], "Z"],
    ["Reset", "View", "turn", "tools/reset", [], "R"],
    ["Center", "Joints", "joint", "joints/center"],
    ["Randomize", "Joints", "joint", "joints/randomize"],
    ["Save", "Views", "view", "views/save"],
    ["Stop", "Drive", "stop", "drive/press", ["5"], "5"],
  ];
  for (const { name, key } of rows.data("tools/list") || [])
    all.push([name, "Tool", name, "tools/choose", [name], key?.toUpperCase()]);
  for (const pose of rows.data("poses/names") || [])
    all.push([pose, "Pose", "joint", "poses/move", [pose]]);
  return all
    .filter(([, , , id]) => rows.can(id))
    .map(([name, where, icon, id, args, keys]) => ({
      kind: "command",
      icon,
      name,
      where,
      keys,
      does: () => actAtOnce(id, args),
    }));
}

/** The buttons of the panels that were not shown when the palette was opened. @type {Target[]} */
let hidden = [];

/** @returns {Target[]} */
function commands() {
  const inMenus = listMenus(() => [], togglePanels, goTo).flatMap((menu) =>
    menu
      .entries()
      .flatMap((entry) =>
        entry && !entry.off ? [{ ...entry, kind: "command", icon: "menu", where: menu.name }] : [],
      ),
  );
  const panels = panelList().map(({ name, title }) => ({
    kind: "panel",
    icon: "hide",
    name: title,
    where: "Panel",
    does: () => openPanel(name),
  }));
  const full = { kind: "command", icon: "full", name: "Full screen", where: "View" };
  const others = inMenus.filter(({ keys }) => keys !== GO_TO);
  const named = [...panels, ...calls(), ...others, { ...full, does: toggleFullScreen }];
  // What is offered in two places is listed once.
  const known = new Set(named.map(({ name }) => name));
  const buttons = [...shownButtons(), ...hidden];
  return [...named, ...buttons.filter(({ name }) => !known.has(name))];
}

/** The key that opens the palette. */
export const GO_TO = "Ctrl+K";
/** Rows that name nothing. */
const UNNAMED = new Set(["note", "lines"]);
/** Panels whose rows are not listed: what is wrong is a sentence, and frames and topics have lists. */
const NOT_BY_ROWS = new Set(["problems", "frames", "topics", "graph"]);

/** The rows of the panels, and the frames. @returns {Target[]} */
function places() {
  /** @param {string} panel @returns {Target[]} */
  const inPanel = (panel) =>
    (rows.panels.get(panel) || []).flatMap((id) => {
      const row = rows.get(id);
      if (!row?.name || row.apart || row.part !== undefined || UNNAMED.has(row.kind)) return [];
      if (row.icon === "frame" && !row.display) return [];
      const where = [SHEET[panel].title, ...namesAbove(row)].join(" › ");
      const icon = panel === "joints" ? "joint" : row.icon || (panel === "views" ? "view" : "");
      const kind = row.display ? "display" : panel;
      const does = () => {
        openPanel(panel);
        reveal(panel, id);
      };
      // A wheel is one whatever it is called.
      const words = row.wheel ? `wheel ${row.help}` : row.help;
      return [{ kind, icon, name: row.name, where, words, does }];
    });
  const frames = rows.panels.get("frames")?.length ? rows.data("names/frames") || [] : [];
  return [
    ...Object.keys(SHEET)
      .filter((panel) => !NOT_BY_ROWS.has(panel))
      .flatMap(inPanel),
    ...frames.map((/** @type {string} */ name) => ({
      kind: "frame",
      icon: "frame",
      name,
      where: "Frames",
      does: () => {
        openPanel("frames");
        fold("frames/all", true);
        reveal("frames", `frame/${name}`);
      },
    })),
    ...(rows.data("names/topics") || []).map((/** @type {string} */ name) => ({
      kind: "topic",
      icon: "",
      name,
      where: "Topics",
      does: () => {
        openPanel("topics");
        // Its row comes with the panel.
        reveal("topics", `topic:${name}`);
      },
    })),
  ];
}

/** @param {{close: () => void}} props */
function Palette({ close }) {
  const all = useMemo(() => [...commands(), ...places()], []);
  const [text, setText] = useState("");
  const [at, setAt] = useState(0);
  const found = useMemo(() => matches(all, text), [text]);
  const shown = found.slice(0, MOST);
  const marked = Math.min(at, shown.length - 1);
  /** @type {Ref} */
  const list = useRef(null);
  // What the mouse marks is not scrolled: it would be another one then.
  const byMouse = useRef(false);
  useLayoutEffect(() => {
    if (!byMouse.current)
      list.current.querySelector("[aria-selected=true]")?.scrollIntoView({ block: "nearest" });
    byMouse.current = false;
  }, [marked, text]);
  /** @param {Target | undefined} target */
  const go = (target) => {
    if (!target) return;
    leaveFor(target.does);
    close();
  };
  /** @param {Key} event */
  const key = (event) => {
    const by = /** @type {Record<string, number>} */ ({
      ArrowDown: 1,
      ArrowUp: -1,
      PageDown: FAR,
      PageUp: -FAR,
    })[event.key];
    if (!by) return;
    const last = shown.length - 1;
    const next = marked + by;
    // One step beyond an end comes in at the other.
    if (Math.abs(by) === 1) setAt(next < 0 ? last : next > last ? 0 : next);
    else setAt(Math.max(0, Math.min(last, next)));
    event.preventDefault();
  };
  return html`<${Dialog} title="Go to" close=${close} submit=${() => go(shown[marked])} look="palette">
    <input role="combobox" data-first aria-expanded="true" aria-controls="palette-list"
      aria-autocomplete="list" aria-label="Go to a display, joint, frame or command"
      placeholder="Display, joint, frame or command" autocomplete="off" spellcheck=${false}
      aria-activedescendant=${marked >= 0 ? `palette-${marked}` : undefined} onKeyDown=${key}
      onInput=${(/** @type {Change} */ e) => {
        setText(e.target.value);
        setAt(0);
      }} />
    <ul class="options" id="palette-list" role="listbox" aria-label="Found" ref=${list}>
      ${shown.map(
        (one, i) => html`<li class="option" role="option" id=${`palette-${i}`} key=${i}
          aria-selected=${String(i === marked)} onClick=${() => go(one)}
          onPointerMove=${() => {
            byMouse.current = i !== marked;
            setAt(i);
          }}>
          <${Icon} name=${one.icon} /><b>${one.name}</b><span class="soft">${one.where}</span>
          ${one.keys && html`<kbd>${one.keys}</kbd>`}</li>`,
      )}
    </ul>
    <p class="soft" role="status">${
      found.length > MOST
        ? `${found.length} results. Type to narrow down.`
        : found.length
          ? `${found.length} found`
          : "Nothing found"
    }</p>
  </${Dialog}>`;
}

/** Open the palette; what is being typed is accepted, as when its field is left. */
export function goTo() {
  takeTyped();
  // Panels cannot be drawn while the palette is.
  hidden = hiddenButtons();
  show(Palette);
}

/** Follow the key of the palette, which also acts while a text is typed. */
export function followPalette() {
  addEventListener(
    "keydown",
    (event) => {
      const held = (event.ctrlKey || event.metaKey) && !event.altKey && !event.shiftKey;
      if (!held || event.key.toLowerCase() !== "k") return;
      // A browser would go to its own search.
      event.preventDefault();
      event.stopPropagation();
      if (!event.repeat && !document.querySelector("dialog[open]")) goTo();
    },
    true,
  );
}

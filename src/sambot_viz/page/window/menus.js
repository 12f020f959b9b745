// @ts-check
/* The menus of the window, as RViz's: File, Edit, View, Panels, Help. */

import { html, useEffect, useLayoutEffect, useRef, useState } from "../vendor/preact.js";
import { act, rows, send } from "../wire/channel.js";
import { show } from "../dialogs/dialog.js";
import { About, Keys } from "../dialogs/help.js";
import {
  download,
  exportPage,
  hasDisk,
  hasRecordings,
  open,
  openAgain,
  openRecording,
  recentNames,
  save,
  saveAs,
  saveImage,
} from "./files.js";
import { Icon } from "./icons.js";
import { copyPermalink } from "../wire/permalink.js";
import { menuKey, usePressOutside } from "./menu.js";
import { EDITS } from "./toolbar.js";
import { Cell, useCommand, useData } from "../state.js";
import { FIRST, setLook } from "../view/look.js";

/**
 * An entry of a menu, or null for a line between entries.
 * @typedef {{name: string, keys?: string, off?: boolean, title?: string, checked?: boolean,
 *   does: () => void} | null} Entry title: why it is off
 * @typedef {{name: string, entries: () => Entry[]}} MenuOf
 * @typedef {{name: string, title: string, shown: boolean, toggle: () => void}} PanelOf
 */

/** A command that viewers may not call is grey for them, with the reason. @param {string} id */
const forControl = (id) =>
  rows.watching && !rows.can(id) ? { off: true, title: "View only: request control first" } : {};

/** @param {"undo" | "redo"} id @param {string} keys @returns {Entry} */
function edit(id, keys) {
  const label = rows.data("edit/labels")?.[id];
  return {
    name: `${EDITS[id]}${label ? ` ${label}` : ""}`,
    keys,
    off: !label,
    does: () => act(`edit/${id}`),
  };
}

/** @typedef {import("../view/look.js").Look} Look */
/** How this browser draws the view, when it was chosen here. @type {Cell<Look | null>} */
const chosenLook = new Cell(/** @type {Look | null} */ (null), "look");
if (chosenLook.value) setLook(chosenLook.value);

/** @param {Look} look @param {string} name @returns {Entry} */
const lookEntry = (look, name) => ({
  name,
  checked: (chosenLook.value ?? FIRST) === look,
  does: () => {
    chosenLook.set(look);
    setLook(look);
  },
});

/** @param {string} side @param {string} name @param {string} [keys] @returns {Entry} */
const sideEntry = (side, name, keys) => ({ name, keys, does: () => act("views/side", [side]) });

/** @returns {Entry} */
function orthographic() {
  const row = rows.get("view/Orthographic");
  const why = row ? {} : { off: true, title: "Views of the type Orbit can do without perspective" };
  const does = () => send("view/Orthographic", !row?.value);
  return { name: "Orthographic", checked: Boolean(row?.value), does, ...why };
}

/**
 * @param {() => PanelOf[]} panels
 * @param {() => void} hideAll
 * @param {() => void} goTo opens the palette
 * @returns {MenuOf[]}
 */
export const listMenus = (panels, hideAll, goTo) => [
  {
    name: "File",
    entries: () => [
      ...(hasRecordings()
        ? [{ name: "Open Recording…", does: openRecording, ...forControl("recording/open") }]
        : []),
      ...(hasDisk()
        ? [
            { name: "Open Config…", does: open, ...forControl("file/open") },
            null,
            { name: "Save Config", keys: "Ctrl+S", does: save, ...forControl("file/save") },
            {
              name: "Save Config As…",
              keys: "Ctrl+Shift+S",
              does: saveAs,
              ...forControl("file/save-as"),
            },
            ...recentNames().map((/** @type {string} */ name) => ({
              name: `Recent: ${name}`,
              does: () => openAgain(name),
              ...forControl("file/open"),
            })),
          ]
        : []),
      { name: "Download Config", does: download },
      null,
      { name: "Save Image…", does: saveImage },
      { name: "Export Page…", does: exportPage, off: !rows.can("file/page") },
    ],
  },
  {
    name: "Edit",
    entries: () => [
      edit("undo", "Ctrl+Z"),
      edit("redo", "Ctrl+Shift+Z"),
      null,
      { name: "Go to…", keys: "Ctrl+K", does: goTo },
      { name: "Copy permalink", does: copyPermalink, off: !rows.can("permalink/copy") },
    ],
  },
  {
    name: "View",
    entries: () => [
      sideEntry("front", "Front", "1"),
      sideEntry("back", "Back"),
      sideEntry("right", "Right Side", "3"),
      sideEntry("left", "Left Side"),
      sideEntry("top", "Top", "7"),
      orthographic(),
      null,
      lookEntry("rviz", "Look: RViz"),
      lookEntry("studio", "Look: Studio"),
    ],
  },
  {
    name: "Panels",
    entries: () => [
      ...panels().map(({ title, shown, toggle }) => ({
        name: title,
        checked: shown,
        does: toggle,
      })),
      null,
      { name: "Hide all", keys: "H", does: hideAll },
    ],
  },
  {
    name: "Help",
    entries: () => [
      { name: "Keys", does: () => show(Keys) },
      { name: "About", does: () => show(About) },
    ],
  },
];

/**
 * The menu bar; on a phone one button for all menus.
 * @param {{panels: () => PanelOf[], hideAll: () => void, goTo: () => void, small: boolean}} props
 */
export function MenuBar({ panels, hideAll, goTo, small }) {
  const all = listMenus(panels, hideAll, goTo);
  /** @returns {Entry[]} */
  const joined = () => all.flatMap((menu, i) => [...(i ? [null] : []), ...menu.entries()]);
  /** @type {MenuOf[]} */
  const bar = small ? [{ name: "Menu", entries: joined }] : all;
  const [opened, setOpened] = useState(-1);
  const [stop, setStop] = useState(0);
  /** @type {Ref} */
  const element = useRef(null);
  /** @param {number} i */
  const headOf = (i) => element.current.querySelectorAll("[aria-haspopup]")[i];
  /** @param {number} i */
  const focusHead = (i) => {
    setStop(i);
    headOf(i)?.focus();
  };
  /** @param {number} i */
  const openMenu = (i) => {
    setStop(i);
    setOpened(i);
  };
  /** @param {number} by */
  const next = (by) => {
    const from = opened >= 0 ? opened : stop;
    const to = (from + by + bar.length) % bar.length;
    if (opened >= 0) openMenu(to);
    else focusHead(to);
  };
  /** @param {Key} event */
  const key = (event) => {
    if (event.key === "ArrowRight") next(1);
    else if (event.key === "ArrowLeft") next(-1);
    else if (event.key === "Escape" && opened >= 0) {
      focusHead(opened);
      setOpened(-1);
    } else if (opened < 0 && ["ArrowDown", "Enter", " "].includes(event.key)) setOpened(stop);
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  usePressOutside([element], () => setOpened(-1), opened >= 0);
  useEffect(() => {
    const close = () => setOpened(-1);
    addEventListener("blur", close);
    return () => removeEventListener("blur", close);
  }, []);
  /** @param {Entry} entry */
  const choose = (entry) => {
    focusHead(Math.max(0, opened));
    setOpened(-1);
    entry?.does();
  };
  return html`<div class="menubar" role="menubar" aria-label="Menus" ref=${element}
    onKeyDown=${key}>
    ${bar.map(
      (menu, i) => html`<div class="menu-place" key=${menu.name}>
      <button class="tool menu-head" role="menuitem" aria-haspopup="menu"
        aria-expanded=${String(opened === i)} aria-label=${menu.name}
        tabindex=${i === stop ? 0 : -1} onClick=${() => (opened === i ? setOpened(-1) : openMenu(i))}
        onPointerEnter=${(/** @type {Press} */ e) => {
          if (opened >= 0 && e.pointerType === "mouse") openMenu(i);
        }}>${small ? html`<${Icon} name="menu" />` : menu.name}</button>
      ${
        opened === i && html`<${Menu} menu=${menu} choose=${choose} leave=${() => setOpened(-1)} />`
      }
    </div>`,
    )}
  </div>`;
}

/** @param {{menu: MenuOf, choose: (entry: Entry) => void, leave: () => void}} props */
function Menu({ menu, choose, leave }) {
  useData("edit/labels");
  useCommand("file/page");
  useData("role/me");
  /** @type {Ref} */
  const element = useRef(null);
  /** @returns {HTMLElement[]} */
  const items = () => [...element.current.querySelectorAll("[role^=menuitem]")];
  useLayoutEffect(() => {
    items()[0]?.focus();
  }, []);
  /** @param {Key} event */
  const key = (event) => {
    if (event.key === "Tab") return leave();
    if (!menuKey(event, items())) return undefined;
    event.preventDefault();
    event.stopPropagation();
    return undefined;
  };
  return html`<div class="menu" role="menu" aria-label=${menu.name} ref=${element} onKeyDown=${key}>
    ${menu.entries().map((entry, i) =>
      entry === null
        ? html`<div role="separator" key=${i}></div>`
        : html`<div key=${entry.name}
          role=${entry.checked === undefined ? "menuitem" : "menuitemcheckbox"} tabindex="-1"
          aria-checked=${entry.checked === undefined ? undefined : String(entry.checked)}
          aria-disabled=${entry.off ? "true" : undefined} title=${entry.title}
            aria-keyshortcuts=${entry.keys?.replace("Ctrl", "Control")}
          onClick=${() => {
            if (!entry.off) choose(entry);
          }}
          onPointerMove=${(/** @type {Press} */ e) => e.currentTarget.focus({ preventScroll: true })}>
        <span class="tick">${entry.checked ? html`<${Icon} name="ok" />` : ""}</span>
        <span class="entry">${entry.name}</span>
        ${entry.keys && html`<kbd>${entry.keys}</kbd>`}</div>`,
    )}
  </div>`;
}

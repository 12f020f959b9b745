// @ts-check
/* The buttons of the window, for the palette: those on the screen, and those of the panels that are
 * not shown, as they would be. */

import { html, render } from "../vendor/preact.js";
import { withoutRows } from "../tree/tree.js";
import { openPanel, panelList, SHEET } from "./panels.js";

/** @typedef {import("./palette.js").Target} Target */

/** What is listed as a menu's entry, a panel or a row. */
const NOT_LISTED = "[role=row] *, [role=tab], [role=menubar] *";

/** The name of the part of the window that an element is in. @param {Element} element */
function partOf(element) {
  const part = element.parentElement?.closest(
    "[role=tabpanel], section[aria-label], aside[aria-label], [role=toolbar], footer[aria-label]",
  );
  return part?.getAttribute("aria-label") || "Window";
}

/** What a button is called. @param {HTMLElement} button */
const nameOf = (button) =>
  (button.getAttribute("aria-label") || button.innerText).replace(/\s+/g, " ").trim();

/** Those that can be pressed. @param {ParentNode} within @returns {HTMLElement[]} */
const pressable = (within) =>
  [...within.querySelectorAll("button:enabled")].flatMap((button) =>
    button instanceof HTMLElement && !button.matches(NOT_LISTED) && nameOf(button) ? [button] : [],
  );

/** Press a button; one that acts while it is held is gone to. @param {HTMLElement} button */
const press = (button) => (button.matches(".way") ? button.focus() : button.click());

/** @param {HTMLElement} button @param {string} where @param {() => void} does @returns {Target} */
const target = (button, where, does) => ({
  kind: "command",
  icon: "button",
  name: nameOf(button),
  where,
  keys: button.getAttribute("aria-keyshortcuts")?.replace("Control", "Ctrl"),
  words: button.title,
  does,
});

/** The buttons that are on the screen. @returns {Target[]} */
export const shownButtons = () =>
  pressable(document.querySelector(".window") || document)
    .filter((button) => button.getClientRects().length > 0)
    .map((button) => target(button, partOf(button), () => press(button)));

/** The buttons of the panels that are not shown; one is pressed once its panel is. @returns {Target[]} */
export function hiddenButtons() {
  return panelList()
    .filter(({ shown }) => !shown)
    .flatMap(({ name, title }) => {
      // Drawn beside the page, and gone before an effect of it has run.
      const beside = document.createElement("div");
      withoutRows(() => render(html`<${SHEET[name].content} />`, beside));
      const found = pressable(beside).map((button) =>
        target(button, title, () => pressIn(name, nameOf(button))),
      );
      render(null, beside);
      return found;
    });
}

/** How often a panel is looked into for its button, a picture of the page apart. */
const LOOKS = 10;

/** Show a panel and press one of its buttons. @param {string} panel @param {string} name */
function pressIn(panel, name, looks = LOOKS) {
  if (looks === LOOKS) openPanel(panel);
  const named = pressable(document.querySelector(".window") || document).filter(
    (one) => nameOf(one) === name && one.getClientRects().length > 0,
  );
  const button = named.find((one) => partOf(one) === SHEET[panel].title) || named[0];
  if (button) press(button);
  else if (looks) requestAnimationFrame(() => pressIn(panel, name, looks - 1));
}

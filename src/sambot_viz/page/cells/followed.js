// @ts-check
/* A joint that messages move: who tries to move it is told what does, and how to end that. */

import { html, useRef, useState } from "../vendor/preact.js";
import { useRow } from "../state.js";
import { usePressOutside } from "../window/menu.js";
import { ValidationMessage } from "./validation_message.js";

/** @typedef {import("../wire/rows.js").Row} Row */

/** Keys that would change a number. */
const CHANGES = new Set(["ArrowUp", "ArrowDown", "Backspace", "Delete"]);

/** What moves the joints in place of the sliders, and what to do; "" while they do.
 * @param {Row | undefined} follow the row that gives the joints to messages, or to the sliders */
export const followedText = (follow) =>
  follow?.value
    ? `This joint is moved by ${String(follow.name).replace(/^Follow /, "")}. Untick Follow to move it here.`
    : "";

/** The same, in a component. */
export const useFollowed = () => followedText(useRow("joints/follow"));

/** What is round a slider: while messages move it, a hand at it is told so.
 * @param {{look: string, off?: boolean, joint?: boolean, children?: any}} props */
export function Slide({ look, off, joint, children }) {
  const moves = useFollowed();
  const why = joint ? moves : "";
  /** @type {Ref} */
  const element = useRef(null);
  const [tried, setTried] = useState(false);
  const told = tried && why !== "" && !off;
  usePressOutside([element], () => setTried(false), told);
  /** @param {Key} event */
  const key = (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key.length === 1 || CHANGES.has(event.key)) setTried(true);
    else if (event.key === "Escape" || event.key === "Tab") setTried(false);
  };
  const followed = why !== "" && !off;
  const listens = followed ? { onPointerDown: () => setTried(true), onKeyDown: key } : {};
  return html`<span class=${followed ? `${look} followed` : look} ref=${element} title=${off || !why ? undefined : why}
    ...${listens}>${children}${told && html`<${ValidationMessage} text=${why} />`}</span>`;
}

// @ts-check
/* What the page says to a notebook's cell that shows it in a frame: that it is there, and that
 * its program has ended. The cell then takes the frame away (jupyter/frame.html): the program
 * comes back at no address that the page knows, and each question would be a traceback in the
 * log of the Jupyter server. */

import { retries } from "./retries.js";

/** So many questions without any answer, about half a minute, and the program has ended. A
 * proxy, such as that of Jupyter, answers in its place at once. */
const ENOUGH = 5;

/** @param {"here" | "gone"} word */
const tell = (word) => parent.postMessage(`sambot-viz: ${word}`, "*");

if (globalThis.window && parent !== window) {
  tell("here");
  retries.listeners.push(({ status, tries }) => {
    if (status !== 200 && (status !== 0 || tries >= ENOUGH)) tell("gone");
  });
}

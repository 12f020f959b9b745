// @ts-check
/* Export Page: what is seen, in one file that needs no server. */

import { html, useState } from "../vendor/preact.js";
import { act, rows } from "../wire/channel.js";
import { currentLook } from "../view/look.js";
import { tell } from "../window/notices.js";
import { Cell } from "../state.js";
import { Dialog } from "./dialog.js";

/** @type {[string, string, string][]} */
const MOTIONS = [
  ["past", "The last minute", "the recorded motion of joints and robot"],
  ["sweep", "All joints", "each to its limits and back, one after the other"],
  ["none", "Nothing", "a view to rotate and zoom"],
];
/** The last choice. */
const last = new Cell("past", "motion");

/** @param {{close: () => void}} props */
export function ExportPage({ close }) {
  // Before anything has moved, there is no last minute.
  const [motion, setMotion] = useState(
    last.value === "past" && rows.data("joints/untouched") ? "sweep" : last.value,
  );
  const save = () => {
    last.set(motion);
    tell("Making the page…", "info");
    act("file/page", [motion, currentLook()]);
    close();
  };
  return html`<${Dialog} title="Export Page" close=${close} submit=${save}>
    <p>Save the view as one HTML file. It opens without this program and without a network.</p>
    <fieldset><legend>Motion</legend>
      ${MOTIONS.map(
        ([id, name, what]) => html`<label class="line choice" key=${id}>
        <input type="radio" name="motion" value=${id} checked=${motion === id}
          data-first=${motion === id ? "" : undefined}
          onChange=${() => setMotion(id)} /> <span>${name}<span class="soft">: ${what}</span></span>
            </label>`,
      )}
    </fieldset>
    <div class="buttons end">
      <button type="submit" class="main">Export</button>
      <button type="button" onClick=${close}>Cancel</button>
    </div>
  </${Dialog}>`;
}

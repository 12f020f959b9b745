// @ts-check
/* Export Page: what is seen, in one file that needs no server. */

import { html, useEffect, useState } from "../vendor/preact.js";
import { act, rows } from "../wire/channel.js";
import { currentLook } from "../view/look.js";
import { Cell, useData } from "../state.js";
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
  const said = useData("notice");
  // The number of the sentence before a page was asked for; what comes after it is the answer.
  const [asked, setAsked] = useState(/** @type {number | null} */ (null));
  const answer = asked !== null && said?.number > asked ? said : null;
  const making = asked !== null && !answer;
  useEffect(() => {
    if (answer?.level === "ok") close();
  }, [answer?.number]);
  const save = () => {
    last.set(motion);
    setAsked(said?.number || 0);
    act("file/page", [motion, currentLook()]);
  };
  return html`<${Dialog} title="Export Page" close=${close} submit=${save}>
    <p>Save the view as one HTML file. It opens without this program and without a network.</p>
    <fieldset><legend>Motion</legend>
      ${MOTIONS.map(
        ([id, name, what]) => html`<label class="line choice" key=${id}>
        <input type="radio" name="motion" value=${id} checked=${motion === id}
          data-first=${motion === id ? "" : undefined}
          onChange=${() => {
            setMotion(id);
            setAsked(null);
          }} /> <span>${name}<span class="soft">: ${what}</span></span>
            </label>`,
      )}
    </fieldset>
    ${answer?.level === "error" && html`<p class="refused" role="alert">${answer.text}</p>`}
    ${making && html`<p class="soft" role="status">Making the page…</p>`}
    <div class="buttons end">
      <button type="submit" class="main" disabled=${making}>Export</button>
      <button type="button" onClick=${close}>Cancel</button>
    </div>
  </${Dialog}>`;
}

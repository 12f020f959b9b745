// @ts-check
/* What another program has saved meanwhile, where it has changed the same lines as the text. */

import { html } from "../vendor/preact.js";
import { useCommand } from "../state.js";

/** @typedef {import("../editor/conflicts.js").Conflict} Conflict */

/** @param {{editor: import("../editor/editor.js").Editor | null, content: any}} props */
export function ModelConflict({ editor, content }) {
  const may = useCommand("model/resolve");
  if (!content?.asks) return null;
  const { file, version, gone } = content;
  /** @type {Conflict[]} */
  const conflicts = content.conflicts;
  const all = (/** @type {boolean} */ theirs) => () => editor?.ask("model/resolve", [file, theirs]);
  const many = conflicts.length > 1 ? " everywhere" : "";
  return html`<div class="note l-warn conflict" role="alert">
    ${
      gone
        ? "This file is gone from the disk."
        : "Another program has saved this file, and changed lines that are changed here too."
    }
    <ul>
      ${conflicts.map(
        (one) => html`<${Place} key=${one.from} editor=${editor} one=${one}
          choose=${may && ((/** @type {boolean} */ theirs) => editor?.ask("model/choose", [file, version, one.from, theirs]))} />`,
      )}
    </ul>
    ${
      may &&
      conflicts.length !== 1 &&
      html`<div class="buttons">
        <button onClick=${all(false)}>${`Keep this text${many}`}</button>
        ${!gone && html`<button onClick=${all(true)}>${`Take the saved text${many}`}</button>`}</div>`
    }
  </div>`;
}

/** @param {{editor: import("../editor/editor.js").Editor | null, one: Conflict,
 *   choose: false | ((theirs: boolean) => void)}} props */
function Place({ editor, one, choose }) {
  const { line, from, to, theirs } = one;
  return html`<li>
    <button class="flat" onClick=${() => editor?.select(from, to)}>Line ${line}</button>
    ${theirs ? html`<pre aria-label="The saved text">${theirs}</pre>` : " The saved text has no such lines. "}
    ${
      choose &&
      html`<span class="buttons">
        <button onClick=${() => choose(false)}>Keep this text</button>
        <button onClick=${() => choose(true)}>Take the saved text</button></span>`
    }</li>`;
}

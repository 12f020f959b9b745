// @ts-check
/* Save Image: a picture of the view at a chosen size, without the panels. */

import { html, useRef } from "../vendor/preact.js";
import { act } from "../wire/channel.js";
import { Cell } from "../state.js";
import { Dialog } from "./dialog.js";

const LONGEST = 4096;
/** The last size [px]. @type {Cell<[number, number]>} */
const size = new Cell(/** @type {[number, number]} */ ([1280, 720]), "picture");

/** @param {{close: () => void}} props */
export function SaveImage({ close }) {
  /** @type {Ref<HTMLInputElement>} */
  const width = useRef(null);
  /** @type {Ref<HTMLInputElement>} */
  const height = useRef(null);
  const save = () => {
    size.set([Number(width.current.value), Number(height.current.value)]);
    act("file/picture", size.value);
    close();
  };
  /** @param {any} ref @param {string} name @param {number} value */
  const side = (ref, name, value) => html`<label class="line"><span class="of">${name}</span>
    <input type="number" aria-label=${name} ref=${ref} min="16" max=${LONGEST} step="1" required
      value=${value}
      data-first=${name === "Width" ? "" : undefined}
        onFocus=${(/** @type {Change} */ e) => e.target.select()} /> <span
          class="unit">pixels</span></label>`;
  return html`<${Dialog} title="Save Image" close=${close} submit=${save}>
    <p>Save the view with its background, without the panels, as a PNG file.</p>
    ${side(width, "Width", size.value[0])}
    ${side(height, "Height", size.value[1])}
    <div class="buttons end">
      <button type="submit" class="main">Save</button>
      <button type="button" onClick=${close}>Cancel</button>
    </div>
  </${Dialog}>`;
}

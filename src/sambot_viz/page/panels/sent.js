// @ts-check
/* What was sent to a live robot: when, by whom, where and what; the newest first. */

import { html } from "../vendor/preact.js";
import { useData } from "../state.js";

/** @typedef {{time: number, who: string, topic: string, type: string, values: string,
 *   count: number}} Line */

/** @param {number} seconds since 1970 */
const clock = (seconds) => new Date(seconds * 1000).toLocaleTimeString();

export function SentPanel() {
  /** @type {Line[]} */
  const lines = useData("sent/lines") || [];
  if (!lines.length) return html`<p class="note">Nothing was sent yet.</p>`;
  return html`<div class="sent" tabindex="0" role="region" aria-label="What was sent">
    <table><thead><tr>${["Time", "Who", "Topic", "Values"].map((name) => html`<th>${name}</th>`)}
      </tr></thead>
      <tbody>${lines.map(
        ({ time, who, topic, type, values, count }) => html`<tr>
          <td>${clock(time)}</td><td>${who || "Somebody"}</td><td title=${type}>${topic}</td>
          <td>${values}${count > 1 && html` <small>(${count} messages)</small>`}</td></tr>`,
      )}</tbody></table></div>`;
}

// @ts-check
/* The text of a lesson: blocks of the server as elements. Nothing in them is HTML. */

import { html } from "../vendor/preact.js";

/**
 * @typedef {[text: string, style: string, href: string]} Span
 * @typedef {{kind: string, lines: Span[][], text: string, word: string, data?: string}} Block
 */

/** @param {{blocks: Block[] | undefined}} props */
export const Blocks = ({ blocks = [] }) => html`${blocks.map(element)}`;

/** @param {Block} block */
function element({ kind, lines, text, word, data }) {
  if (kind === "code") return html`<pre><code>${text}</code></pre>`;
  if (kind === "picture")
    return data
      ? html`<img src=${data} alt=${text} />`
      : html`<p class="soft">[${text || word}]</p>`;
  if (kind === "list" || kind === "numbers") {
    const items = lines.map((line) => html`<li>${line.map(piece)}</li>`);
    return kind === "list" ? html`<ul>${items}</ul>` : html`<ol>${items}</ol>`;
  }
  const words = lines.map((line) => line.map(piece));
  if (kind !== "heading") return html`<p>${words}</p>`;
  return Number(word) < 3 ? html`<h3>${words}</h3>` : html`<h4>${words}</h4>`;
}

/** @param {Span} span */
function piece([text, style, href]) {
  if (style === "strong") return html`<strong>${text}</strong>`;
  if (style === "em") return html`<em>${text}</em>`;
  if (style === "code") return html`<code>${text}</code>`;
  if (style === "link" && /^https?:\/\//.test(href))
    return html`<a href=${href} target="_blank" rel="noopener noreferrer">${text}</a>`;
  return text;
}

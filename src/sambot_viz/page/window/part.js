// @ts-check
/* A part of the window that cannot be drawn says so, and leaves the others as they are. */

import { html, useErrorBoundary } from "../vendor/preact.js";

/**
 * A panel, or another part, that fails alone.
 * @param {{title: string, children: any}} props title: as people know it
 */
export function Part({ title, children }) {
  const [error, again] = useErrorBoundary((failure) => console.error(`${title}:`, failure));
  if (!error) return children;
  const why = `${title} cannot be shown: ${error.message ?? error}.`;
  return html`<div class="failed" role="alert">
    <p>${why} The rest of the page goes on. Please report this with what the browser's console
      says.</p>
    <button onClick=${again}>Show it again</button>
  </div>`;
}

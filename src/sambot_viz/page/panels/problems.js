// @ts-check
/* What is wrong: the list, and the count that opens it. */

import { html, useEffect, useRef } from "../vendor/preact.js";
import { Icon } from "../icons.js";
import { useRow } from "../state.js";
import { Tree } from "../tree.js";

const KINDS = /** @type {const} */ ([["error", "error"], ["warning", "warn"], ["info", "info"]]);

/**
 * @typedef {{shown: boolean, show: (on: boolean) => void, byItself: boolean}} Shown
 *   whether the list is shown; byItself: whether there is room to open it for every error
 */

export function ProblemsPanel() {
  return html`<${Tree} panel="problems" label="Problems" split=${false} hover=${false} />`;
}

/**
 * How many problems there are. Errors open the list, and close it again when they go.
 * @param {Shown} props
 */
export function ProblemCount({ shown, show, byItself }) {
  const count = useRow("problems/count")?.value;
  useOpening(count, { shown, show, byItself });
  const all = KINDS.map(([name, level]) => ({ name, level, number: count?.[name] || 0 })).filter(({ number }) => number);
  const words = all.map(({ name, number }) => `${number} ${number === 1 || name === "info" ? name : `${name}s`}`).join(", ");
  return html`<button class="problem-count" aria-expanded=${String(shown)} title=${`${shown ? "Hide" : "Show"} the problems`}
      onClick=${() => show(!shown)}>
    ${all.length ? all.map(({ name, level, number }) => html`<span key=${name} class=${`l-${level}`} aria-hidden="true"><${Icon} name=${level} /> ${number}</span>`)
      : html`<span aria-hidden="true"><${Icon} name="ok" /> No problems</span>`}
    <span class="spoken">${words ? `Problems: ${words}` : "No problems"}</span>
  </button>`;
}

/** Open the list for new errors; what was opened so is closed when there are none.
 * @param {any} count @param {Shown} list */
function useOpening(count, { shown, show, byItself }) {
  const last = useRef({ errors: -1, old: false });
  const opened = useRef(false);
  useEffect(() => {
    if (!count) return;
    const before = last.current;
    last.current = { errors: count.error, old: count.old };
    if ((byItself && count.error > Math.max(0, before.errors)) || (count.old && !before.old)) {
      opened.current = opened.current || !shown;
      show(true);
    } else if (!count.error && (opened.current || before.errors < 0)) {
      // What was open when the page was left is not opened for mere warnings.
      opened.current = false;
      if (shown) show(false);
    }
  }, [count?.error, count?.old]);
  // A hand that has closed or opened it decides.
  useEffect(() => { if (!shown) opened.current = false; }, [shown]);
}

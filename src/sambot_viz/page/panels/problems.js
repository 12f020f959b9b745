// @ts-check
/* What is wrong: the list, and the count that opens it. */

import { html, useEffect } from "../vendor/preact.js";
import { Icon } from "../window/icons.js";
import { useData, wantedRow } from "../state.js";
import { Tree } from "../tree/tree.js";
import { edited, EDITED, rows } from "../wire/channel.js";

const KINDS = /** @type {const} */ ([
  ["error", "error"],
  ["warning", "warn"],
  ["info", "info"],
]);

/**
 * @typedef {{shown: boolean, show: (on: boolean, byItself?: boolean) => void, byItself: boolean,
 *   byHand: () => boolean}} Shown
 *   whether the list is shown; byItself: whether there is room to open it for every error; byHand:
 *   whether it would take the place of what is read or written
 */

export function ProblemsPanel() {
  return html`<${Tree} panel="problems" label="Problems" split=${false} hover=${false} />`;
}

/**
 * How many displays have errors. It comes and goes with an edit: no button is moved by it.
 */
export function ErrorCount() {
  /** @type {string[]} the rows of Global Status and of displays, in this order */
  const inError = useData("displays/errors") || [];
  if (!inError.length) return null;
  return html`<button class="problem-count" title="Show it in Displays"
      onClick=${() => wantedRow.set({ panel: "displays", id: inError[0] })}>
      <span class="l-error"><${Icon} name="error" /> ${inWords(inError)}</span></button>`;
}

/**
 * How many problems there are. Errors among them open the list, and close it again when they go.
 * @param {Shown} props
 */
export function ProblemCount({ shown, show, byItself, byHand }) {
  const count = useData("problems/count");
  useOpening(count, { shown, show, byItself, byHand });
  /** @type {string[]} the rows of Global Status and of displays, in this order */
  const inError = useData("displays/errors") || [];
  return html`<button class="problem-count" aria-expanded=${String(shown)}
    title=${`${shown ? "Hide" : "Show"} the problems`}
      onClick=${() => show(!shown)}><${Numbers} of=${counted(count)} icon=${count?.checking ? "" : "ok"}
        none=${count?.checking ? "Checking…" : inError.length ? "No other problems" : "No problems"} /></button>`;
}

/** @param {string[]} inError */
function inWords(inError) {
  if (inError[0] === "status") return "Global Status: Error";
  return inError.length === 1 ? "1 display in Error" : `${inError.length} displays in Error`;
}

/**
 * The number of problems in a corner of the view, while the panels are hidden.
 * @param {{show: () => void}} props
 */
export function ProblemCorner({ show }) {
  const all = counted(useData("problems/count"));
  if (!all.length) return null;
  return html`<button class="problem-count corner" title="Show the panels and the problems"
    onClick=${show}><${Numbers} of=${all} /></button>`;
}

/** The kinds of problems that there are. @param {any} count */
function counted(count) {
  return KINDS.map(([name, level]) => ({ name, level, number: count?.[name] || 0 })).filter(
    ({ number }) => number,
  );
}

/** @param {{of: ReturnType<typeof counted>, none?: string, icon?: string}} props */
function Numbers({ of, none, icon }) {
  const words = of
    .map(({ name, number }) => `${number} ${number === 1 || name === "info" ? name : `${name}s`}`)
    .join(", ");
  return html`${
    of.length
      ? of.map(
          ({ name, level, number }) =>
            html`<span key=${name} class=${`l-${level}`} aria-hidden="true">
              <${Icon} name=${level} /> ${number}</span>`,
        )
      : html`<span aria-hidden="true">${icon && html`<${Icon} name=${icon} />`}
          <span class=${icon && "none"}> ${none}</span></span>`
  }
    <span class="spoken">${words ? `Problems: ${words}` : none}</span>`;
}

/** What the list was opened for, also while the panels are hidden. */
const known = { errors: -1, old: false, opened: false };

/** Open the list for new errors; what was opened so is closed when there are none.
 * @param {any} count @param {Shown} list */
function useOpening(count, { shown, show, byItself, byHand }) {
  useEffect(() => {
    if (!count) return;
    const before = { ...known };
    Object.assign(known, { errors: count.error, old: count.old });
    if (byHand() && !shown) return;
    if ((byItself && count.error > Math.max(0, before.errors)) || (count.old && !before.old)) {
      known.opened = known.opened || !shown;
      if (!shown) show(true, true);
    } else if (!count.error && (known.opened || before.errors < 0)) {
      // What was open when the page was left is not opened for mere warnings.
      known.opened = false;
      if (shown) show(false);
    }
  }, [count?.error, count?.old]);
  // One who has applied a fix goes on with what is left.
  useEffect(
    () =>
      rows.listen(EDITED, () => {
        if (edited() === "problems/apply") known.opened = false;
      }),
    [],
  );
  // A hand that has closed or opened it decides.
  useEffect(() => {
    if (!shown) known.opened = false;
  }, [shown]);
}

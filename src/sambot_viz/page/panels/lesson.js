// @ts-check
/* The Lesson panel: a step, what holds of it, and the list of all steps. */

import { html, useLayoutEffect, useRef, useState } from "../vendor/preact.js";
import { useCommand, useData } from "../state.js";
import { Icon } from "../window/icons.js";
import { act } from "../wire/channel.js";
import { Blocks } from "./lesson_text.js";

/**
 * @typedef {{title: string, points: number, passed: boolean}} Step
 * @typedef {{holds: boolean, text: string, place: string}} Outcome
 * @typedef {{outcomes: Outcome[] | null, tries: number, passed: boolean, checking: boolean,
 *   trouble: string, hint_in: number, also: number[]}} State
 * @typedef {{number: number, text: string, link: string, name: string}} Teacher
 */

/** The points that there are, and those that are earned. @param {Step[]} steps */
export function earned(steps) {
  const sum = (/** @type {Step[]} */ some) => some.reduce((all, { points }) => all + points, 0);
  return `${sum(steps.filter(({ passed }) => passed))} of ${sum(steps)} points`;
}

/** What is said below the conditions. @param {State} state */
export function verdict({ outcomes, tries, passed, checking, hint_in }) {
  if (checking || !outcomes) return "Checking…";
  if (outcomes.every(({ holds }) => holds))
    return passed ? "All holds." : "All holds: Check, or save, to go on.";
  const tried = tries ? `${tries} ${tries === 1 ? "try" : "tries"} so far. ` : "";
  const before = passed ? "It has held before. " : tried;
  if (!hint_in || passed) return before;
  return `${before}A hint comes after ${hint_in} ${hint_in === 1 ? "try" : "tries"} more.`;
}

/** What is said of other steps that have come to hold. @param {number[]} also their numbers */
export function counted(also) {
  if (!also.length) return "";
  const [last, ...others] = [...also].reverse();
  const numbers = others.length ? `${others.reverse().join(", ")} and ${last}` : `${last}`;
  return also.length === 1
    ? `Step ${numbers} holds too: it has its points.`
    : `Steps ${numbers} hold too: they have their points.`;
}

export function LessonPanel() {
  const all = useData("lesson/steps");
  const text = useData("lesson/text");
  /** @type {Ref} */
  const scrolled = useRef(null);
  useLayoutEffect(() => {
    if (scrolled.current) scrolled.current.scrollTop = 0;
  }, [all?.shown]);
  if (!all || !text) return null;
  return html`<div class="panel lesson">
    <${FromTeacher} />
    <${Steps} title=${all.title} shown=${all.shown} steps=${all.steps} />
    <${News} steps=${all.steps} />
    <div class="page" ref=${scrolled}>
      <h2>${`${all.shown}. ${text.title}`}</h2>
      <${Blocks} blocks=${text.blocks} />
      ${
        text.other_model &&
        html`<p class="l-warn">This step is about ${text.other_model}: open its tab in Model. The
          view shows the file of another step.</p>`
      }
      <${Conditions} />
      <${Hints} />
    </div>
    <${Buttons} shown=${all.shown} count=${all.steps.length} />
  </div>`;
}

/** In a class: what the teacher says, and whose page is shown to all. */
function FromTeacher() {
  /** @type {Teacher | undefined} */
  const said = useData("lesson/teacher");
  const [read, setRead] = useState(0);
  if (!said) return null;
  const unread = said.text && said.number > read;
  // Who looks at the page of another one is below it.
  const home = location.pathname.replace(/student\/\d+\/$/, "");
  return html`${
    unread &&
    html`<p class="teacher" role="alert"><b>Teacher:</b> ${said.text}
      <button onClick=${() => setRead(said.number)}>Close</button></p>`
  }${
    said.link
      ? html`<p class="teacher" role="status">The teacher shows${" "}
          <a href=${home + said.link} target="_blank">the robot of ${said.name}</a>.</p>`
      : said.name && html`<p class="teacher" role="status">Your robot is shown to all.</p>`
  }`;
}

/** @param {{title: string, shown: number, steps: Step[]}} props */
function Steps({ title, shown, steps }) {
  const may = useCommand("lesson/show");
  /** @type {Ref} */
  const list = useRef(null);
  const go = (/** @type {number} */ number) => () => {
    list.current.removeAttribute("open");
    act("lesson/show", [number]);
  };
  return html`<details class="steps" ref=${list}>
    <summary>${title}<span class="soft">${earned(steps)}</span></summary>
    <ol>
      ${steps.map(
        (step, at) => html`<li key=${at}>
          <button disabled=${!may} aria-current=${at + 1 === shown ? "step" : undefined}
            onClick=${go(at + 1)}>
            <span class=${step.passed ? "l-ok" : "soft"}>
              ${step.passed ? html`<${Icon} name="ok" />` : `${at + 1}`}</span>
            ${step.title}<span class="soft">${step.points}</span></button></li>`,
      )}
    </ol>
  </details>`;
}

/** What has come to hold besides the step that is read. @param {{steps: Step[]}} props */
function News({ steps }) {
  /** @type {State | undefined} */
  const state = useData("lesson/state");
  const isDone = steps.every(({ passed }) => passed);
  const said = isDone ? "All steps hold: the lesson is done." : counted(state?.also || []);
  return html`<p class="news l-ok" role="status">${said}</p>`;
}

function Conditions() {
  /** @type {State | undefined} */
  const state = useData("lesson/state");
  if (!state) return null;
  return html`<h3>What has to hold</h3>
    <ul class="conditions" aria-live="polite">
      ${(state.outcomes || []).map(
        ({ holds, text, place }) => html`<li key=${text} class=${holds ? "holds" : "fails"}>
          <span class=${holds ? "l-ok" : "l-error"}><${Icon} name=${holds ? "ok" : "error"} />
            <span class="spoken">${holds ? "holds" : "does not hold"}</span></span>
          <span>${text}${place && html` <span class="soft">${place}</span>`}</span></li>`,
      )}
    </ul>
    <p class="verdict" role="status">${verdict(state)}</p>
    ${state.trouble && html`<p class="l-error" role="alert">${state.trouble}</p>`}`;
}

function Hints() {
  /** @type {import("./lesson_text.js").Block[][]} */
  const hints = useData("lesson/hints") || [];
  const before = useRef(hints.length);
  /** @type {Ref} */
  const last = useRef(null);
  // One that has just come may be below what is seen.
  useLayoutEffect(() => {
    if (hints.length > before.current) last.current?.scrollIntoView({ block: "nearest" });
    before.current = hints.length;
  }, [hints.length]);
  return html`${hints.map(
    (blocks, at) => html`<section class="hint" key=${at} ref=${last}
      aria-label=${`Hint ${at + 1}`}>
      <h3>${`Hint ${at + 1}`}</h3><${Blocks} blocks=${blocks} /></section>`,
  )}`;
}

/** @param {{shown: number, count: number}} props */
function Buttons({ shown, count }) {
  const may = useCommand("lesson/check");
  /** @type {State | undefined} */
  const state = useData("lesson/state");
  const go = (/** @type {number} */ by) => () => act("lesson/show", [shown + by]);
  return html`<div class="buttons">
    <button disabled=${!may || shown === 1} onClick=${go(-1)}>Back</button>
    <button class=${state?.passed ? "" : "main"} disabled=${!may || state?.checking}
      onClick=${() => act("lesson/check")}>Check</button>
    <button class=${state?.passed ? "main" : ""} disabled=${!may || shown === count}
      onClick=${go(1)}>Next</button>
    <span class="soft">${shown} of ${count}</span>
  </div>`;
}

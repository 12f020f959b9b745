// @ts-check
/* The status bar: Reset, the tool's hint, what is being read, what was said last, and
 * how the page is doing. Its parts have their places, so that nothing jumps. */

import { html, useEffect, useState } from "../vendor/preact.js";
import { act } from "../wire/channel.js";
import { CutText } from "./cut_text.js";
import { Icon } from "./icons.js";
import { notice } from "./notices.js";
import { ErrorCount, ProblemCount } from "../panels/problems.js";
import { People } from "./people.js";
import { Driving } from "../panels/drive.js";
import { ByNumbersButton, UseMapButton } from "../dialogs/by_numbers.js";
import { LiveDriving, LiveGoal } from "../panels/live_drive.js";
import { useData, wantedRow } from "../state.js";

/** How long a sentence stays, and how long one about a mistake, which is also at its row [ms]. */
const SAID = 8000;
const REFUSED = 20000;

/** @param {{problems: import("../panels/problems.js").Shown}} props */
export function StatusBar({ problems }) {
  const tool = useData("tools/hint");
  const hint = (matchMedia("(pointer: coarse)").matches ? tool?.touch : tool?.text) || "";
  /** @type {{current: boolean, first: boolean}[]} */
  const tools = useData("tools/list") || [];
  const chosen = tools.some(({ current, first }) => current && !first);
  return html`<footer class=${`statusbar${chosen ? " by-tool" : ""}`} aria-label="Status bar">
    <button class="needs-control" title="Reset (R): reload meshes and redraw" aria-label="Reset"
      aria-keyshortcuts="R" onClick=${() => act("tools/reset")}>
      <span class="brief"><${Icon} name="turn" /></span><span class="words">Reset</span></button>
    <${ProblemCount} ...${problems} />
    <${ErrorCount} />
    <${Selected} />
    <${CutText} is="hint" role="status" text=${hint} />
    <${UseMapButton} /><${ByNumbersButton} />
    <${Said} />
    <${NotFollowing} />
    <${Driving} />
    <${LiveDriving} />
    <${LiveGoal} />
    <${Progress} />
    <${People} />
    <${FramesPerSecond} />
  </footer>`;
}

/** What is selected in the view. */
function Selected() {
  const names = useData("tools/selected") || [];
  if (!names.length) return null;
  const words = names.length === 1 ? `Selected: ${names[0]}` : `${names.length} items selected`;
  return html`<${CutText} is="selected" role="status" text=${words} />`;
}

/** While the sliders move the joints, and not the messages of the live robot: leads to Follow. */
function NotFollowing() {
  if (!useData("joints/unfollowed")) return null;
  return html`<button class="not-following" aria-label="Not following the robot"
    title="The sliders move the joints, and not the robot's messages: show Follow"
    onClick=${() => wantedRow.set({ panel: "joints", id: "joints/follow" })}>
    <span class="brief">Not following</span><span class="words">Not following the robot</span>
  </button>`;
}

/** What was said last. */
function Said() {
  const said = notice.use();
  useEffect(() => {
    if (!said) return undefined;
    const timer = setTimeout(() => notice.set(null), said.level === "error" ? REFUSED : SAID);
    return () => clearTimeout(timer);
  }, [said]);
  return html`<${CutText} is=${`notice l-${said?.level || "none"}`} role="alert"
    text=${said?.text || ""} />`;
}

function Progress() {
  const read = useData("statusbar/progress");
  if (!read) return null;
  const words = `Reading meshes and textures: ${read[0]} of ${read[1]}`;
  return html`<span class="progress" title=${words}>${words}
    <progress aria-label=${words} value=${read[0]} max=${read[1]}></progress></span>`;
}

/** Frames per second; none are drawn while nothing changes. */
function FramesPerSecond() {
  const [drawn, setDrawn] = useState(0);
  useEffect(() => {
    let before = window.sambotVizLook?.frames || 0;
    const timer = setInterval(() => {
      const now = window.sambotVizLook?.frames || 0;
      setDrawn(now - before);
      before = now;
    }, 1000);
    return () => clearInterval(timer);
  }, []);
  return html`<span class="fps" title="Frames per second; nothing is drawn while nothing moves">
    ${drawn > 1 ? `${drawn} fps` : "idle"}</span>`;
}

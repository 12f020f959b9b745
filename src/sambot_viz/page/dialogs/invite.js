// @ts-check
/* Invite: the link for viewers, large enough to be read from a projector, and as a QR code. */

import { html, useEffect } from "../vendor/preact.js";
import { act } from "../wire/channel.js";
import { copy } from "../window/clipboard.js";
import { Dialog } from "./dialog.js";
import { useData } from "../state.js";

/** The quiet zone round a QR code [modules]. */
const BORDER = 4;

/** @param {{close: () => void}} props */
export function Invite({ close }) {
  /** @type {{asked: string, link: string, dark: string[], only_here: boolean} | undefined} */
  const invitation = useData("people/invitation");
  // The address under which this page was opened: a proxy may have another one than the server.
  const here = location.origin + location.pathname.replace(/copy\/$/, "");
  useEffect(() => act("people/invite", [here]), []);
  const made = invitation?.asked === here ? invitation : undefined;
  return html`<${Dialog} title="Invite" close=${close} wide>
    <div class="invite">
      ${made && html`<${Code} dark=${made.dark} />`}
      <p class="link">${made?.link || "…"}</p>
      ${
        made?.only_here &&
        html`<p class="l-warn">Only works on this computer. Start with --host 0.0.0.0 to let
          others in.</p>`
      }
      <div class="buttons end">
        <button type="button" class="main" data-first disabled=${!made}
          onClick=${() => made && copy(made.link, "Link copied")}>Copy the link</button>
        <button type="button" onClick=${close}>Close</button>
      </div>
    </div>
  <//>`;
}

/** A QR code; its dark modules are 1. @param {{dark: string[]}} props */
function Code({ dark }) {
  const size = dark.length + 2 * BORDER;
  const path = dark
    .flatMap((line, y) =>
      [...line].map((module, x) => (module === "1" ? `M${x + BORDER} ${y + BORDER}h1v1h-1z` : "")),
    )
    .join("");
  return html`<svg class="code" role="img" aria-label="QR code of the link" shape-rendering="crispEdges"
    viewBox=${`0 0 ${size} ${size}`}><rect width=${size} height=${size} fill="#fff" />
    <path d=${path} fill="#000" /></svg>`;
}

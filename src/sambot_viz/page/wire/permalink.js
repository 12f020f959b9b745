// @ts-check
/* Permalinks: the joints, the view, the toggles and the selection in the part of
 * an address that no browser sends to a server. */

import { act, rows } from "./channel.js";
import { copy } from "../window/clipboard.js";
import { hasJoints } from "./reconnect.js";

/** What is in the part after the "#" of a link, which a hand may have written. */
const PART = /[#&](view|robot|time|fixed|select|v|(view|j|show)\.[^=&]*)=/;
/** A robot that is not there after this time [ms] is not waited for. */
const PATIENCE = 15_000;

/** Whether the end of an address is for this program. @param {string} hash */
export const isPermalink = (hash) => PART.test(hash);

/** What a permalink says, from the address. @param {string} hash @returns {[string[], string[]]} */
export function partsOf(hash) {
  const pairs = [...new URLSearchParams(hash.replace(/^#/, ""))];
  return [pairs.map(([name]) => name), pairs.map(([, value]) => value)];
}

/**
 * The address of a page that shows this.
 * @param {string[][]} parts
 * @param {{origin: string, pathname: string}} of
 */
export function addressOf(parts, { origin, pathname }) {
  const written = new URLSearchParams(parts).toString();
  // These need no code there, and the names of joints and links are read more easily.
  return `${origin}${pathname}#${written.replace(/%(2F|3A|2C)/g, decodeURIComponent)}`;
}

/** Copy a permalink of what this browser shows. */
export function copyPermalink() {
  act("permalink/copy");
}

/** Open permalinks from now on: that of the page's own address, and those that come later. */
export function followPermalinks() {
  /** What is still to be opened. @type {string} */
  let waiting = "";
  let patient = false;
  const open = () => {
    // A page without a Joints panel has nothing to wait for.
    const early = patient && rows.panels.has("joints") && !hasJoints();
    if (!waiting || !rows.knows("permalink/open") || early) return;
    const parts = partsOf(waiting);
    waiting = "";
    act("permalink/open", parts);
  };
  const take = () => {
    const hash = window.sambotPermalink || location.hash;
    window.sambotPermalink = undefined;
    if (!isPermalink(hash)) return;
    waiting = hash;
    // A page that is loaded again shows what is there then.
    if (location.hash) history.replaceState(null, "", location.pathname + location.search);
    patient = true;
    setTimeout(() => {
      patient = false;
      open();
    }, PATIENCE);
    open();
  };
  let made = 0;
  rows.listen("permalink/made", () => {
    const now = rows.data("permalink/made");
    if (!now || now.number === made) return;
    made = now.number;
    void copy(addressOf(now.parts, location), "Link copied");
  });
  rows.listen("whole:browser", open);
  rows.listen("joints/untouched", open);
  addEventListener("hashchange", take);
  take();
}

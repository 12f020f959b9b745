// @ts-check
/* The last picture of a change is drawn once more: what came late is in it, and so are all pixels.
 * On a slow machine viser draws with fewer of them, also at rest; a motion that lasts has viser's
 * choice again. An address with fixedDpr says itself how many there are. */

/** So long after the last change the view is at rest [ms]. */
const REST = 600;
/** A change that is over sooner, such as one click, is drawn with all pixels [ms]. */
const LASTS = 150;
/** What is asked for so shortly after the picture became sharp comes of that [ms]. */
const SETTLES = 400;
/** viser begins with no more pixels than this, and no fewer than one, in a CSS pixel. */
const MOST = 2;

const fixed = new URLSearchParams(globalThis.location?.search).has("fixedDpr");
/** The functions that we have put in place of viser's. @type {WeakSet<Function>} */
const ours = new WeakSet();
/** What viser had chosen when the picture became sharp. @type {number | null} */
let chosen = null;
let sharpened = -Infinity;
/** When the motion after it began. @type {number | null} */
let began = null;
let timer = 0;

/** Follow what is asked to be drawn. @param {any} mutable viser's */
export function keepSharp(mutable) {
  const draw = mutable?.requestRender;
  if (!draw || ours.has(draw)) return;
  mutable.requestRender = () => {
    draw();
    const now = performance.now();
    if (chosen !== null && now - sharpened > SETTLES) {
      began ??= now;
      if (now - began > LASTS) {
        stateOf(mutable)?.setDpr(chosen);
        chosen = null;
      }
    }
    clearTimeout(timer);
    timer = setTimeout(() => sharpen(mutable), REST);
  };
  ours.add(mutable.requestRender);
  mutable.requestRender();
}

/** The state of the library that draws viser's scene. @param {any} mutable */
const stateOf = (mutable) => mutable.scene?.__r3f?.root.getState();

/** @param {any} mutable */
function sharpen(mutable) {
  began = null;
  const state = stateOf(mutable);
  const full = Math.min(MOST, Math.max(1, devicePixelRatio));
  if (fixed || !(state?.viewport.dpr < full)) {
    state?.invalidate();
    return;
  }
  chosen = state.viewport.dpr;
  sharpened = performance.now();
  // This draws it too.
  state.setDpr(full);
}

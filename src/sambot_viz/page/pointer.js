// @ts-check
/* The mouse over the 3D view: where it is, and that the view has the focus after a click. */

/** At most so many places of the mouse are sent in a second. */
const HOVERS = 20;

const canvas = () => window.__viserMutable?.canvas;

/** @typedef {[number | null, number | null]} Place from left and top, 0 to 1; null outside the view */
/** @type {Place} */
const OUTSIDE = [null, null];
let place = OUTSIDE;

/** Where the mouse is in the view. @returns {Place} */
export const mousePlace = () => place;

/** Names in the scene lie over the canvas. @param {EventTarget | null} target */
function inView(target) {
  return target instanceof Node && Boolean(document.getElementById("root")?.contains(target));
}

/** @param {PointerEvent} event @returns {Place} */
function placeOf(event) {
  const box = canvas()?.getBoundingClientRect();
  if (!box || !box.width || !box.height || !inView(event.target)) return OUTSIDE;
  const x = (event.clientX - box.left) / box.width, y = (event.clientY - box.top) / box.height;
  return x >= 0 && x <= 1 && y >= 0 && y <= 1 ? [x, y] : OUTSIDE;
}

/**
 * Follow the mouse.
 * @param {() => boolean} wanted whether places are to be sent now
 * @param {(place: Place) => void} send
 */
export function followMouse(wanted, send) {
  let sent = OUTSIDE, timer = 0, last = -Infinity;
  const sendLast = () => {
    timer = 0;
    if (!wanted() || (place[0] === sent[0] && place[1] === sent[1])) return;
    last = performance.now();
    sent = place;
    send(place);
  };
  /** @param {Place} next */
  const moved = (next) => {
    place = next;
    if (!timer && wanted()) timer = window.setTimeout(sendLast, Math.max(0, last + 1000 / HOVERS - performance.now()));
  };
  addEventListener("pointermove", (event) => {
    // A finger does not hover, and with a button the mouse turns the view.
    if (event.pointerType !== "touch") moved(event.buttons ? OUTSIDE : placeOf(event));
  }, true);
  document.addEventListener("pointerleave", () => moved(OUTSIDE));
  addEventListener("pointerdown", (event) => {
    const view = canvas();
    if (!view || !inView(event.target)) return;
    if (view.tabIndex < 0) {
      view.tabIndex = 0;
      view.setAttribute("role", "application");
      view.setAttribute("aria-label", "3D view");
    }
    view.focus({ preventScroll: true });
  }, true);
}

// @ts-check
/* The mouse over the 3D view: where it is, and that the view has the focus after a click. */

/** Maximum number of places of the mouse sent in a second. */
const HOVERS = 20;

/** What has the mouse and the focus of the view; of a page without one, its empty place.
 * @returns {HTMLElement | null} */
const canvas = () => window.__viserMutable?.canvas || document.getElementById("no-view");

/**
 * @typedef {[number | null, number | null]} Place from left and top, 0 to 1; null outside the view
 */
/** @type {Place} */
const OUTSIDE = [null, null];
let place = OUTSIDE;

/** Where the mouse is in the view. @returns {Place} */
export const mousePlace = () => place;

/** Names in the scene lie over the canvas. @param {EventTarget | null} target */
function inView(target) {
  return target instanceof Node && Boolean(document.getElementById("root")?.contains(target));
}

/** @param {MouseEvent} event @returns {Place} */
function placeOf(event) {
  const box = canvas()?.getBoundingClientRect();
  if (!box || !box.width || !box.height || !inView(event.target)) return OUTSIDE;
  const x = (event.clientX - box.left) / box.width;
  const y = (event.clientY - box.top) / box.height;
  return x >= 0 && x <= 1 && y >= 0 && y <= 1 ? [x, y] : OUTSIDE;
}

/** Where an event is in the view; null outside.
 * @param {MouseEvent} event @returns {[number, number] | null} */
export function placeIn(event) {
  const [x, y] = placeOf(event);
  return x === null || y === null ? null : [x, y];
}

/** The pointer that was pressed in the view last. */
let pressed = -1;

/** End what a held button does in the view, such as drawing a rectangle, without its effect. */
export function cancelPress() {
  canvas()?.dispatchEvent(new PointerEvent("pointercancel", { pointerId: pressed, bubbles: true }));
}

/** A press that moves less than this is a click [px]. */
const CLICK = 4;

/**
 * Follow the mouse.
 * @param {{wantsHover: () => boolean, hover: (place: [number, number]) => void, rightClick: () =>
 *   void, twice: (place: [number, number]) => void, enter: () => void}} to
 *   hover: called while the tool wants it, when the place has changed; enter: the mouse has come in
 */
export function followMouse({ wantsHover, hover, rightClick, twice, enter }) {
  /** @type {Place} */
  let sent = OUTSIDE;
  let timer = 0;
  let last = -Infinity;
  const sendLast = () => {
    timer = 0;
    const [x, y] = place;
    if (x === null || y === null || !wantsHover() || (x === sent[0] && y === sent[1])) return;
    last = performance.now();
    sent = place;
    hover([x, y]);
  };
  addEventListener(
    "pointermove",
    (event) => {
      // A finger does not hover, and with a button the mouse turns the view.
      if (event.pointerType === "touch") return;
      const before = place;
      place = event.buttons ? OUTSIDE : placeOf(event);
      if (before === OUTSIDE && place !== OUTSIDE) enter();
      const pause = last + 1000 / HOVERS - performance.now();
      if (!timer && wantsHover()) timer = window.setTimeout(sendLast, Math.max(0, pause));
    },
    true,
  );
  document.addEventListener("pointerleave", () => {
    place = OUTSIDE;
  });
  addEventListener("dblclick", (event) => {
    const [x, y] = placeOf(event);
    if (x !== null && y !== null) twice([x, y]);
  });
  /** Where the right button was pressed in the view. @type {{x: number, y: number} | null} */
  let right = null;
  addEventListener(
    "pointerdown",
    (event) => {
      right = null;
      if (!inView(event.target)) return;
      pressed = event.pointerId;
      if (event.button === 2) right = { x: event.clientX, y: event.clientY };
      focusView();
    },
    true,
  );
  addEventListener(
    "pointerup",
    (event) => {
      if (event.button !== 2 || !right) return;
      const moved = Math.hypot(event.clientX - right.x, event.clientY - right.y);
      right = null;
      if (moved < CLICK) rightClick();
    },
    true,
  );
}

/** After a click the view has the focus, and no text field any more. */
export function focusView() {
  const view = canvas();
  if (!view) return;
  if (view.tabIndex < 0) {
    view.tabIndex = 0;
    view.setAttribute("role", "application");
    view.setAttribute("aria-label", "3D view");
  }
  view.focus({ preventScroll: true });
}

// @ts-check
/* viser tells the program how many pixels it draws, which become fewer while a slow machine moves
 * the picture. What is computed of it, such as the Scale of TopDownOrtho, is of the window. */

/** The canvases that tell the size of the window. @type {WeakSet<HTMLCanvasElement>} */
const ours = new WeakSet();

/** Have the page report CSS pixels. @param {any} mutable viser's */
export function reportWindow(mutable) {
  /** @type {HTMLCanvasElement | null | undefined} */
  const canvas = mutable?.canvas;
  if (!canvas || ours.has(canvas)) return;
  ours.add(canvas);
  tell(canvas, "width", () => canvas.clientWidth);
  tell(canvas, "height", () => canvas.clientHeight);
  // Nothing is reported here: the first report opens the session, and what it then says of the
  // camera would come before viser has put its own first one there.
}

/**
 * Let a size be read from the window, and be set as before: the renderer only sets it.
 * @param {HTMLCanvasElement} canvas @param {"width" | "height"} side @param {() => number} get
 */
function tell(canvas, side, get) {
  const drawn = Object.getOwnPropertyDescriptor(HTMLCanvasElement.prototype, side);
  const set = (/** @type {number} */ pixels) => drawn?.set?.call(canvas, pixels);
  Object.defineProperty(canvas, side, { configurable: true, get, set });
}

// @ts-check
/* viser's connection in a page without a view, where viser's own script is not.
 *
 * The server knows a page by it, and gives it rows as soon as a camera was reported. So one is
 * reported, that of a page which viser has just opened; what the server sends is not read. */

/** Which version of viser the server is. */
const protocol = () =>
  document.querySelector("meta[name=sambot-viser]")?.getAttribute("content") || "";

/** @param {string} letters ASCII, fewer than 32 */
const text = (letters) => [0xa0 | letters.length, ...new TextEncoder().encode(letters)];
/** @param {number} value */
const float = (value) => [0xcb, ...bytesOf((view) => view.setFloat64(0, value), 8)];
/** @param {number} value */
const pixels = (value) => [0xcd, ...bytesOf((view) => view.setUint16(0, value), 2)];
/** @param {number[]} values */
const vector = (...values) => [0x90 | values.length, ...values.flatMap(float)];

/** @param {(view: DataView) => void} write @param {number} count */
function bytesOf(write, count) {
  const view = new DataView(new ArrayBuffer(count));
  write(view);
  return new Uint8Array(view.buffer);
}

/** What viser says of its camera at first, in MessagePack.
 * @param {number} width @param {number} height of the picture [px] */
export function firstCamera(width, height) {
  const fields = {
    type: text("ViewerCameraMessage"),
    wxyz: vector(...LOOKS),
    position: vector(3, 3, 3),
    fov: float((75 * Math.PI) / 180),
    near: float(0.01),
    far: float(1000),
    image_height: pixels(height),
    image_width: pixels(width),
    look_at: vector(0, 0, 0),
    up_direction: vector(0, 0, 1),
  };
  const written = Object.entries(fields).map(([name, value]) => [...text(name), ...value]);
  return new Uint8Array([0x80 | written.length, ...written.flat()]);
}
/** From (3, 3, 3) to the origin, with z up: w x y z of x right, y down, z forward. */
const LOOKS = [0.1759199, -0.3398511, -0.8204732, 0.4247082];

/** @type {WebSocket | null} */
let socket = null;

/** @type {NonNullable<typeof window.sambotViser>} */
const viser = { state: "opening", open, changed: () => undefined };

function open() {
  socket?.close();
  const opened = new WebSocket(window.sambotSocket || "", [protocol()]);
  socket = opened;
  viser.state = "opening";
  /** @param {"open" | "closed"} state */
  const become = (state) => {
    if (socket !== opened) return;
    viser.state = state;
    viser.changed(state);
  };
  opened.onopen = () => {
    opened.send(firstCamera(innerWidth, innerHeight));
    become("open");
  };
  opened.onclose = () => become("closed");
}

if (globalThis.window) {
  window.sambotViser = viser;
  open();
}

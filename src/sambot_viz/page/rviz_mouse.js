// @ts-check
/* Makes the mouse move viser's camera as RViz's views do: left turns, middle or
 * Shift+left moves, right or the wheel zooms, with RViz's radians and metres per pixel.
 * The type of view is in the data of an element that the toolbar makes. Only settings
 * that viser's camera-controls already has are changed; without it, viser's own mouse
 * stays.
 *
 * RViz zooms by 1 % of the distance per pixel of a right drag, here it is 0.5 %; a
 * notch of the wheel is the same 12 %.
 */
(() => {
  "use strict";
  if (window.sambotVizMouse) return;
  const state = { kind: "" };
  window.sambotVizMouse = state;
  const page = () => window.__viserMutable;
  const controls = () => page()?.cameraControl;
  /** Set what differs. @param {any} object @param {string} key @param {unknown} value */
  const put = (object, key, value) => { if (object[key] !== value) object[key] = value; };

  // RViz's steepest pitch is this far from straight down: there yaw is still defined.
  const POLE = 0.001;
  /** viser's numbers for what a button does. @type {any} */
  let actions = null;
  /** @param {any} c camera-controls */
  const settings = (c) => {
    const height = page()?.canvas.clientHeight || 1;
    const turn = 0.005 * height / (2 * Math.PI);
    const above = state.kind === "TopDownOrtho", inside = state.kind === "FPS";
    const reach = c.distance * Math.tan(c.camera.fov * Math.PI / 360);
    put(c, "azimuthRotateSpeed", above ? -turn : turn);
    put(c, "polarRotateSpeed", turn);
    put(c, "minPolarAngle", above ? 0 : POLE);
    put(c, "maxPolarAngle", above ? 0 : Math.PI - POLE);
    put(c, "truckSpeed", inside ? -0.01 * height / reach : 2);
    put(c, "dollySpeed", 0.75);
    put(c, "dollyDragInverted", true);
    const b = c.mouseButtons;
    if (!actions) actions = { turn: b.left, move: b.right, zoom: b.wheel, none: 0 };
    put(b, "middle", actions.move);
    put(b, "right", inside ? actions.none : actions.zoom);
    put(b, "wheel", inside ? actions.none : actions.zoom);
  };
  const refresh = () => {
    /** @type {HTMLElement | null} */
    const mark = document.querySelector("[data-sambot-view]");
    const c = controls();
    if (!mark || !c) return;
    state.kind = mark.dataset.sambotView || "";
    settings(c);
  };
  setInterval(refresh, 200);

  /** @param {Event} event */
  const onCanvas = (event) => page() !== undefined && event.target === page()?.canvas;
  window.addEventListener("pointerdown", (event) => {
    refresh();
    const c = controls();
    if (c && actions) c.mouseButtons.left = event.shiftKey ? actions.move : actions.turn;
  }, true);
  /** FPS walks; camera-controls only approaches its target. @param {number} metres */
  const walk = (metres) => {
    const c = controls(), way = c.camera.position.clone();
    c.camera.getWorldDirection(way);
    const at = c.getTarget(way.clone()).addScaledVector(way, metres);
    c.moveTo(at.x, at.y, at.z, false);
  };
  window.addEventListener("wheel", (event) => {
    if (state.kind === "FPS" && onCanvas(event)) walk(-0.012 * event.deltaY);
  }, true);
  window.addEventListener("pointermove", (event) => {
    if (state.kind === "FPS" && onCanvas(event) && event.buttons === 2) walk(-0.1 * event.movementY);
  }, true);

  // S is the key of Select; viser's camera would walk backwards while it is held.
  window.addEventListener("keydown", (event) => {
    if (event.code === "KeyS") document.dispatchEvent(new KeyboardEvent("keyup", { code: "KeyS" }));
  });
})();

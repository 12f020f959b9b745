// @ts-check
/* What viser is told of its server: where that is, and when to ask it again.
 *
 * viser leaves the slash at the end of an address away, and for /robot/ would ask for /robot,
 * which some proxies (that of Jupyter) answer with a redirect, and a websocket follows none. It
 * takes the address out of the query; that is gone again when the page is there (rviz_look.js).
 * viser's worker asks for a server that has gone whenever viser tells it to, once a second: what
 * viser tells it is dropped, and `wire/retries.js` says when.
 * What the worker has received is taken apart first, where it says what has moved (viser_poses.js).
 * The view is hidden until it has the camera of its server (view/camera.js): at first viser shows
 * one of its own.
 * This runs before viser, not as a module. */

if (new URLSearchParams(location.search).get("channel") !== "none") {
  const { classList } = document.documentElement;
  classList.add("no-camera");
  // Whatever has failed: a view with another camera is more than none.
  setTimeout(() => classList.remove("no-camera"), 10000);
}

{
  const query = new URLSearchParams(location.search);
  query.set("websocket", window.sambotSocket || "");
  history.replaceState(null, "", `?${query}`);
}

{
  /** @type {Worker | null} */
  let worker = null;
  const post = Worker.prototype.postMessage;
  /** @type {NonNullable<typeof window.sambotViser>} */
  const viser = {
    state: "opening",
    open() {
      viser.state = "opening";
      if (worker) post.call(worker, { type: "retry" });
    },
    changed: () => undefined,
  };
  window.sambotViser = viser;
  /** @param {MessageEvent} event */
  const heard = ({ data }) => {
    if (data?.type !== "connected" && data?.type !== "closed") return;
    viser.state = data.type === "connected" ? "open" : "closed";
    viser.changed(viser.state);
  };
  /** @param {Worker["onmessage"]} take viser's @returns {Worker["onmessage"]} */
  const unpackedFor = (take) =>
    function unpack(event) {
      const { data } = event;
      if (data?.type === "connected") window.sambotPoses?.clear();
      if (data?.type === "message_batch" && window.sambotPoses)
        data.messages = window.sambotPoses.unpacked(data.messages);
      take?.call(this, event);
    };
  /** @this {Worker} @param {any} message @param {any} [rest] */
  Worker.prototype.postMessage = function postMessage(message, rest) {
    if (message?.type === "set_server") {
      worker = this;
      worker.onmessage = unpackedFor(worker.onmessage);
      worker.addEventListener("message", heard);
    }
    if (this !== worker || message?.type !== "retry") post.call(this, message, rest);
  };
}

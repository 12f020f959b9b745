// @ts-check
/* What is taken from the page's address before viser reads it, and what is put into it.
 *
 * Where the websockets are: in the folder of the page. viser leaves the slash at the end
 * away, and for /robot/ would ask for /robot, which some proxies (that of Jupyter) answer with
 * a redirect, and a websocket follows none. viser takes the address out of the query; it is
 * gone again when the page is there (rviz_look.js). The ticket in it belongs to this page as
 * long as it is open: by it, the server knows which connections are those of one page.
 * viser's worker asks for a server that has gone whenever viser tells it to, once a second: what
 * viser tells it is dropped, and `wire/retries.js` says when.
 * This runs before viser, not as a module. */

// What `permalink.js` opens: viser would drop it.
window.sambotPermalink = location.hash;
if (location.hash) history.replaceState(null, "", location.pathname + location.search);

{
  const ticket = Array.from(crypto.getRandomValues(new Uint8Array(16)), (n) =>
    n.toString(16).padStart(2, "0"),
  ).join("");
  window.sambotSocket = `${location.origin.replace(/^http/, "ws")}${location.pathname}?ticket=${ticket}`;
  const query = new URLSearchParams(location.search);
  query.set("websocket", window.sambotSocket);
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
  /** @this {Worker} @param {any} message @param {any} [rest] */
  Worker.prototype.postMessage = function postMessage(message, rest) {
    if (message?.type === "set_server") {
      worker = this;
      worker.addEventListener("message", heard);
    }
    if (this !== worker || message?.type !== "retry") post.call(this, message, rest);
  };
}

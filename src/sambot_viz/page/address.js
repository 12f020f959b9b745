// @ts-check
/* What is taken from the page's address before anything else reads it.
 *
 * The websockets are in the folder of the page. The ticket in their address belongs to this page
 * as long as it is open: by it, the server knows which connections are those of one page.
 * This runs first, not as a module. */

// What `permalink.js` opens: viser would drop it.
window.sambotPermalink = location.hash;
if (location.hash) history.replaceState(null, "", location.pathname + location.search);

{
  const ticket = Array.from(crypto.getRandomValues(new Uint8Array(16)), (n) =>
    n.toString(16).padStart(2, "0"),
  ).join("");
  window.sambotSocket = `${location.origin.replace(/^http/, "ws")}${location.pathname}?ticket=${ticket}`;
}

// @ts-check
/* What is taken from the page's address before viser reads it.
 *
 * Where the websocket is: in the folder of the page. viser leaves the slash at the end
 * away, and for /robot/ would ask for /robot, which some proxies (that of Jupyter) answer with
 * a redirect, and a websocket follows none. viser takes the address out of the query; it is
 * gone again when the page is there (rviz_look.js). This runs before viser, not as a module. */

// What `permalink.js` opens: viser would drop it.
window.sambotPermalink = location.hash;
if (location.hash) history.replaceState(null, "", location.pathname + location.search);

if (location.pathname !== "/" && location.pathname.endsWith("/")) {
  const query = new URLSearchParams(location.search);
  query.set("websocket", location.origin.replace(/^http/, "ws") + location.pathname);
  history.replaceState(null, "", `?${query}`);
}

// @ts-check
/* viser's own panel is only shown when a script has added widgets to it. */

/** Whether there is a widget beside the elements that bring our rows. */
function hasWidgets() {
  const ours = document.querySelector("#root script[data-sambot]");
  const all = ours?.parentElement?.parentElement?.children || [];
  return [...all].some((child) => !child.querySelector(":scope > script[data-sambot]"));
}

/** Follow viser's page from now on. */
export function followScript() {
  const root = /** @type {HTMLElement} */ (document.getElementById("root"));
  const look = () => document.body.classList.toggle("sambot-script", hasWidgets());
  new MutationObserver(look).observe(root, { childList: true, subtree: true });
  look();
}

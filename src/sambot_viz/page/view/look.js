// @ts-check
/* How the view is drawn: as RViz draws it, or with soft light and round shapes (Studio). The
 * server says what a page begins with; what one browser has chosen is in menus.js. */

/** @typedef {"rviz" | "studio"} Look */

/** @type {HTMLMetaElement | null} */
const said = document.querySelector('meta[name="sambot-look"]');
/** What a browser shows that has chosen nothing. @type {Look} */
export const FIRST = said?.content === "studio" ? "studio" : "rviz";
/** @type {Look} */
let now = FIRST;

/** @returns {Look} */
export const currentLook = () => now;

/** Draw in another way from now on. @param {Look} look */
export function setLook(look) {
  now = look;
  window.__viserMutable?.requestRender?.();
}

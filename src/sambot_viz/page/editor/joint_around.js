// @ts-check
/* The joint in whose element a cursor is. */

/** Longest element of a joint that is looked at, back from the cursor [UTF-16 units]. */
const FAR = 5000;

/** @param {string} text @param {number} at @returns {string} its name; "" outside of joints */
export function jointAround(text, at) {
  const before = text.slice(Math.max(0, at - FAR), at + 1);
  const start = before.lastIndexOf("<joint");
  if (start < 0 || before.indexOf("</joint>", start) >= 0) return "";
  const tag = before.slice(start) + text.slice(at + 1, at + FAR).split("</joint>")[0];
  const [own] = tag.split(">");
  if (own.endsWith("/") && before.indexOf(">", start) >= 0) return "";
  return /^<joint\s[^>]*?\bname\s*=\s*["']([^"'$]+)["']/.exec(own)?.[1] ?? "";
}

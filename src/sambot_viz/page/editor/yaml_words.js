// @ts-check
/* What the editor offers in a parameter file: nodes, their parameters, and values of those. */

/** @typedef {Record<string, Record<string, string[]>>} Keys node → parameter → values; "" has the names
 *   of the nodes, "-" is a list of maps */

const KEY = /^([ ]*(?:- +)?)["']?([\w./*]*)$/;
const VALUE = /^[ ]*(?:- +)?["']?([\w.]+)["']?:\s+(?:\[.*,)?\s*["'[]?([\w:/]*)$/;
const ABOVE = /^([ ]*)["']?\/?(?:[\w*]+\/)*([\w*]+)["']?:/;

/**
 * @param {string} before the text up to the cursor @param {Keys} keys
 * @returns {{from: number, labels: string[], ends: string} | null} where the word begins, what it may
 *   be, and what comes behind it
 */
export function offeredIn(before, keys) {
  const lines = before.split("\n");
  const line = /** @type {string} */ (lines.pop());
  const node = nodeOf(lines, line, keys);
  const key = KEY.exec(line);
  if (key) {
    const labels = Object.keys(keys[node] ?? keys[""] ?? {});
    return found(before, key[2], labels, ": ");
  }
  const value = VALUE.exec(line);
  return value && found(before, value[2], keys[node]?.[value[1]] || [], "");
}

/** @param {string} before @param {string} word @param {string[]} labels @param {string} ends */
const found = (before, word, labels, ends) =>
  labels.length ? { from: before.length - word.length, labels, ends } : null;

/** The node that a line belongs to: the nearest above that is known, with less before it.
 * @param {string[]} above @param {string} line @param {Keys} keys */
function nodeOf(above, line, keys) {
  if (keys["-"]) return "-";
  let depth = line.length - line.trimStart().length;
  for (let at = above.length - 1; at >= 0 && depth > 0; at--) {
    const one = ABOVE.exec(above[at]);
    if (!one || one[1].length >= depth) continue;
    depth = one[1].length;
    if (one[2] && keys[one[2]]) return one[2];
  }
  return "";
}

// @ts-check
/* Arguments of static_transform_publisher, in which people also write sums and units. */

import { formatNumber, parseNumber } from "./numbers.js";

const PROGRAM = "static_transform_publisher";
/** The units of the first values of the old form, and of the flags of the new one. */
const IN_ORDER = ["m", "m", "m", "rad", "rad", "rad"];
/** @type {Record<string, string>} */
const FLAGS = {
  "--x": "m",
  "--y": "m",
  "--z": "m",
  "--roll": "rad",
  "--pitch": "rad",
  "--yaw": "rad",
};
const PLAIN = /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i;

/**
 * What was pasted with numbers in place of sums and units, such as pi/2, 90deg or 5cm; words that
 * are no such thing stay, for the server to explain.
 * @param {string} pasted
 */
export function workedOut(pasted) {
  const words = pasted.trim().split(/\s+/);
  const first = words.findIndex((word) => word.endsWith(PROGRAM)) + 1;
  const end = words.indexOf("--ros-args");
  const count = (end < 0 ? words.length : end) - first;
  return words
    .map((word, i) => {
      const unit = FLAGS[words[i - 1]] || (count === 8 ? IN_ORDER[i - first] : undefined);
      if (!unit || PLAIN.test(word)) return word;
      const read = parseNumber(word, unit);
      return "value" in read ? String(formatNumber(read.value, 12)) : word;
    })
    .join(" ");
}

// @ts-check
/* Numbers as people type and read them. */

const FACTORS = /** @type {Record<string, number>} */ ({
  "°": Math.PI / 180, deg: Math.PI / 180, degree: Math.PI / 180, degrees: Math.PI / 180,
  rad: 1, m: 1, cm: 0.01, mm: 0.001, km: 1000,
});
const LENGTHS = ["m", "cm", "mm", "km"];

/**
 * Read a number: "0.5", "1,5", "1e-3", "pi/2", "-90deg", "2*pi", "15 mm", "(1+2)/4".
 * @param {string} typed
 * @param {string} unit the unit of a plain number: "rad", "°", "m" or anything else
 * @returns {{value: number} | {error: string}} the value in rad or m where that is the unit
 */
export function parseNumber(typed, unit = "") {
  const text = typed.trim().toLowerCase().replace(/−/g, "-").replace(/π/g, "pi");
  if (!text) return { error: "type a number" };
  const match = text.match(/^(.*?)\s*(°|deg|degrees?|rad|cm|mm|km|m)?$/s);
  const [, expression = "", named] = match || [];
  const angle = unit === "rad" || unit === "°";
  if (named && angle === LENGTHS.includes(named) && (angle || unit === "m")) {
    return { error: `'${named}' does not fit ${angle ? "an angle" : "a length"}` };
  }
  if (named && !angle && unit !== "m" && unit !== named) return { error: `no unit '${named}' here` };
  const value = evaluate(expression);
  if (value === undefined || !Number.isFinite(value)) {
    return { error: `'${typed.trim()}' is not a number` };
  }
  const factor = FACTORS[named || (angle ? unit : "")] ?? 1;
  return { value: value * factor };
}

/** A sum of products of numbers, pi and brackets. @param {string} text @returns {number | undefined} */
function evaluate(text) {
  // A comma is a decimal point, as in many countries.
  const tokens = text.replace(/(\d),(?=\d)/g, "$1.").match(/\d+\.?\d*(?:e[+-]?\d+)?|\.\d+(?:e[+-]?\d+)?|pi|tau|[-+*/()]|\S/g);
  if (!tokens) return undefined;
  let at = 0;
  const sum = () => {
    let left = product();
    while (tokens[at] === "+" || tokens[at] === "-") {
      left = tokens[at++] === "+" ? left + product() : left - product();
    }
    return left;
  };
  const product = () => {
    let left = factor();
    for (;;) {
      if (tokens[at] === "*") { at++; left *= factor(); }
      else if (tokens[at] === "/") { at++; left /= factor(); }
      // "2pi" and "2(1+1)"
      else if (tokens[at] === "pi" || tokens[at] === "tau" || tokens[at] === "(") left *= factor();
      else return left;
    }
  };
  /** @returns {number} */
  const factor = () => {
    const token = tokens[at++];
    if (token === "-") return -factor();
    if (token === "+") return factor();
    if (token === "pi") return Math.PI;
    if (token === "tau") return 2 * Math.PI;
    if (token === "(") {
      const inner = sum();
      return tokens[at++] === ")" ? inner : NaN;
    }
    return token !== undefined && /^[\d.]/.test(token) ? Number(token) : NaN;
  };
  const value = sum();
  return at === tokens.length ? value : undefined;
}

/** The text of a number, with few digits but never a different value on the last shown digit.
 * @param {number} value @param {number} digits after the point */
export function formatNumber(value, digits = 6) {
  if (!Number.isFinite(value)) return "";
  const size = Math.abs(value);
  if (size !== 0 && (size >= 1e7 || size < 10 ** -digits)) return String(Number(value.toPrecision(6)));
  return String(Number(value.toFixed(digits)));
}

/** A value moved by some steps, on round numbers. @param {number} value @param {number} step @param {number} count */
export function stepped(value, step, count) {
  const next = Math.round(value / step) + count;
  const on = Math.abs(Math.round(value / step) * step - value) < step * 1e-6;
  const from = on ? next : count > 0 ? Math.floor(value / step) + count : Math.ceil(value / step) + count;
  return round(from * step, step);
}

/** A value on the nearest step. @param {number} value @param {number} step */
export function snapped(value, step) { return round(Math.round(value / step) * step, step); }

/** Without the last digits that binary numbers add. @param {number} value @param {number} step */
function round(value, step) {
  const digits = Math.max(0, 2 - Math.floor(Math.log10(step)));
  return Number(value.toFixed(Math.min(12, digits)));
}

/** @param {number} value @param {{min?: number, max?: number}} row */
export function clamped(value, { min = -Infinity, max = Infinity }) {
  return Math.min(max, Math.max(min, value));
}

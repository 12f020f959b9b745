// @ts-check
/* Numbers as people type and read them. */

const DEGREE = Math.PI / 180;
/**
 * What a unit measures, and how much of rad or m it is.
 * @type {Record<string, ["angle" | "length", number]>}
 */
const UNITS = {
  rad: ["angle", 1],
  radian: ["angle", 1],
  radians: ["angle", 1],
  "°": ["angle", DEGREE],
  deg: ["angle", DEGREE],
  degree: ["angle", DEGREE],
  degrees: ["angle", DEGREE],
  m: ["length", 1],
  cm: ["length", 0.01],
  mm: ["length", 0.001],
  km: ["length", 1000],
};
const SUFFIX = /^(.*?)\s*(°|deg|degrees?|rad|radians?|[ckm]?m)?\s*(\/\s*s)?$/s;

/**
 * Read a number: "0.5", "1,5", "1e-3", "pi/2", "-90deg", "2*pi", "15 mm", "(1+2)/4".
 * @param {string} typed
 * @param {string} unit the unit of a plain number: "rad", "°", "m", each also with "/s", or
 *   anything else;
 *   an angle with pi or tau is in radians all the same
 * @returns {{value: number} | {error: string}} the value in rad or m where that is the unit
 */
export function parseNumber(typed, unit = "") {
  const text = typed.trim().toLowerCase().replace(/−/g, "-").replace(/π/g, "pi");
  if (!text) return { error: "Enter a number" };
  const [, expression = "", named = "", perSecond = ""] = text.match(SUFFIX) || [];
  const value = evaluate(expression);
  if (value === undefined || !Number.isFinite(value)) {
    return { error: `'${typed.trim()}' is not a number` };
  }
  const own = UNITS[unit.replace("/s", "")];
  const circle = own?.[0] === "angle" && /pi|tau/.test(expression);
  if (!named && !perSecond) return { value: value * (own && !circle ? own[1] : 1) };
  const given = UNITS[named];
  if (!given || !own || given[0] !== own[0] || (perSecond && !unit.endsWith("/s"))) {
    return { error: `'${named}${perSecond}' does not fit: the unit is ${unit || "none"}` };
  }
  return { value: value * given[1] };
}

/**
 * A sum of products of numbers, pi and brackets.
 * @param {string} text
 * @returns {number | undefined}
 */
function evaluate(text) {
  // A comma is a decimal point, as in many countries.
  const tokens = text
    .replace(/,(?=\d)/g, ".")
    .match(/\d+\.?\d*(?:e[+-]?\d+)?|\.\d+(?:e[+-]?\d+)?|pi|tau|[-+*/()]|\S/g);
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
      if (tokens[at] === "*") {
        at++;
        left *= factor();
      } else if (tokens[at] === "/") {
        at++;
        left /= factor();
      }
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
  // What sums of binary numbers leave over.
  if (size < 1e-12) return "0";
  if (size >= 1e7 || size < 10 ** -digits) return String(Number(value.toPrecision(6)));
  return String(Number(value.toFixed(digits)));
}

/**
 * A number in a sentence: with a minus, not a hyphen.
 * @param {number} value
 * @param {number} digits
 */
export function writtenNumber(value, digits) {
  return formatNumber(value, digits).replace(/-/g, "−");
}

/** The text of a number in a field without much room. While a number runs, the count of its digits stays.
 * @param {number} value
 * @param {number} digits after the point, at most
 * @param {number} room characters, at least 6
 */
export function fittingNumber(value, digits, room) {
  const exact = formatNumber(value, 9);
  if (exact.length <= room && (exact.split(".")[1] || "").length <= digits && !exact.includes("e"))
    return exact;
  const whole = Math.trunc(Math.abs(value)).toFixed().length + (value < 0 ? 1 : 0);
  const text = value.toFixed(Math.max(0, Math.min(digits, room - whole - 1)));
  // What is very small is not shown as 0.
  if (text.length <= room && Number(text) !== 0) return text;
  return value
    .toExponential(value < 0 ? room - 6 : room - 5)
    .replace("+", "")
    .replace(/\.?0*e/, "e");
}

/**
 * A value moved by some steps, to a round number.
 * @param {number} value
 * @param {number} step
 * @param {number} count
 */
export function stepped(value, step, count) {
  const near = Math.round(value / step);
  const on = Math.abs(near * step - value) < step * 1e-6;
  const from = on ? near : count > 0 ? Math.floor(value / step) : Math.ceil(value / step);
  return round((from + count) * step, step);
}

/** A value on the nearest step. @param {number} value @param {number} step */
export function snapped(value, step) {
  return round(Math.round(value / step) * step, step);
}

/** Without the last digits that binary numbers add. @param {number} value @param {number} step */
function round(value, step) {
  const digits = Math.max(0, 2 - Math.floor(Math.log10(step)));
  return Number(value.toFixed(Math.min(12, digits)));
}

/** @param {number} value @param {{min?: number, max?: number}} row */
export function clamped(value, { min = -Infinity, max = Infinity }) {
  return Math.min(max, Math.max(min, value));
}

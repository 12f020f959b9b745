// @ts-check
/* How large the panels are: what a hand has chosen, and what the window has room for. */

/**
 * Sizes that a hand has chosen [px], and the width of the window where it did.
 * @typedef {{left?: number, right?: number, side?: number, bottom?: number, views?: number, at?:
 *   number}} Chosen
 * @typedef {{left: number, right: number, side: number, bottom: number, views: number}} Sizes each
 *   is a property of the window's style
 */

/** A panel that gives way does not become smaller [px]. */
const LEAST = 200;
/** A hand does not make one smaller [px]. */
export const SMALLEST = 90;
/**
 * What all panels beside the view may have, as a part of the window: where a hand has chosen, and
 * else.
 */
export const MOST = 0.7;
export const HALF = 0.52;

/** @param {number} low @param {number} value @param {number} high */
export const between = (low, value, high) => Math.round(Math.max(low, Math.min(value, high)));

/**
 * The sizes for a window. In a narrower one than the hand has had, panels give way: half is view.
 * @param {Chosen} chosen @param {number} width @param {number} height [px]
 * @param {Record<string, boolean>} away which sides are folded
 * @returns {Sizes}
 */
export function fitted(chosen, width, height, away = {}) {
  const part = chosen.at !== undefined && width >= chosen.at ? MOST : HALF;
  const left = chosen.left ?? between(230, 0.215 * width, 300);
  const right = chosen.right ?? between(330, 0.3 * width, 430);
  const beside = (away.left ? 0 : left) + (away.right ? 0 : right);
  const spare = (/** @type {number} */ size) => Math.max(0, size - LEAST);
  const beyond = Math.max(0, beside - Math.max(part * width, 2 * LEAST));
  const both = (away.left ? 0 : spare(left)) + (away.right ? 0 : spare(right));
  /** @param {number} size */
  const give = (size) => Math.round(size - (both ? Math.min(1, beyond / both) * spare(size) : 0));
  return {
    left: give(left),
    right: give(right),
    side: between(
      SMALLEST,
      chosen.side ?? Math.max(300, Math.min(0.42 * width, 440)),
      HALF * width,
    ),
    bottom: between(SMALLEST, chosen.bottom ?? 210, HALF * height),
    views: between(SMALLEST, chosen.views ?? 240, HALF * height),
  };
}

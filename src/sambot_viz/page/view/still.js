// @ts-check
/* A view in which nothing changes draws nothing. viser draws once a second for ever, for the sake
 * of changes that ask for no picture; sharp.js draws one picture after each change instead.
 * This runs before viser, not as a module: viser begins its heartbeat as soon as it has a scene. */

{
  const begin = window.setInterval;
  /** viser's heartbeat is the one timer of a second that does nothing but one call. */
  const CALL = /^\(\)\s*=>\s*[\w$]+\(\)$/;
  /** @param {any} run @param {number} [every] @param {any[]} rest */
  const still = (run, every, ...rest) => {
    if (every !== 1000 || !CALL.test(String(run))) return begin(run, every, ...rest);
    window.setInterval = begin;
    // No timer has this number: to end it does nothing.
    return 0;
  };
  window.setInterval = /** @type {typeof window.setInterval} */ (still);
}

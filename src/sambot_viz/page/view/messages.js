// @ts-check
/* What viser is told of the scene, when it takes it up: just before a picture. */

/** @type {Set<(messages: any[]) => void>} */
const listeners = new Set();

/** Call a function with the messages that viser takes up; returns a function that ends that.
 * @param {(messages: any[]) => void} listener */
export function followMessages(listener) {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/** @param {any[]} queue viser's */
function follow(queue) {
  const take = queue.splice;
  queue.splice = (/** @type {[number, number, ...any[]]} */ ...args) => {
    const taken = take.apply(queue, args);
    if (taken.length) for (const listener of listeners) listener(taken);
    return taken;
  };
}

const timerOfStart = globalThis.window
  ? setInterval(() => {
      const queue = window.__viserMutable?.messageQueue;
      if (!queue) return;
      clearInterval(timerOfStart);
      follow(queue);
    }, 20)
  : 0;

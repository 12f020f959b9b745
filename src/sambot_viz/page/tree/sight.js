// @ts-check
/* Which rows of a tree are in sight: found from their places, whatever scrolls them. */

/**
 * The part of a list that reaches into a band: from the first one on, up to before the last.
 * @template T
 * @param {T[]} list one below the other @param {number} top @param {number} bottom
 * @param {(one: T) => {top: number, bottom: number}} place
 * @returns {[number, number]}
 */
export function within(list, top, bottom, place) {
  /** @param {(one: T) => boolean} isBelow @param {number} low */
  const first = (isBelow, low) => {
    let high = list.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (isBelow(list[middle])) high = middle;
      else low = middle + 1;
    }
    return low;
  };
  const from = first((one) => place(one).bottom > top, 0);
  return [from, first((one) => place(one).top >= bottom, from)];
}

export class Sight {
  /**
   * @param {HTMLElement} host the tree; its parent scrolls it, or what that is in
   * @param {() => void} look called when other rows may have come into sight
   * @param {() => void} resized called when rows may have other heights
   */
  constructor(host, look, resized) {
    this.host = host;
    this.listeners = new AbortController();
    addEventListener(
      "scroll",
      ({ target }) => target instanceof Node && target.contains(host) && look(),
      { capture: true, passive: true, signal: this.listeners.signal },
    );
    let width = host.clientWidth;
    this.observer = new ResizeObserver(() => {
      if (host.clientWidth !== width) resized();
      width = host.clientWidth;
      // Rows that are drawn in this call may have other heights, which it would not hear of.
      requestAnimationFrame(look);
    });
    for (let one = /** @type {HTMLElement | null} */ (host); one; one = one.parentElement)
      this.observer.observe(one);
  }

  /**
   * The part of the rows that is in sight.
   * @template T
   * @param {T[]} list @param {(one: T) => {top: number, bottom: number}} place
   * @returns {[number, number]}
   */
  of(list, place) {
    const box = (this.host.parentElement || this.host).getBoundingClientRect();
    return within(list, Math.max(0, box.top), Math.min(innerHeight, box.bottom), place);
  }

  end() {
    this.listeners.abort();
    this.observer.disconnect();
  }
}

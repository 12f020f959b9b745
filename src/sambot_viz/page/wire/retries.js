// @ts-check
/* When a page that has lost its connection asks for the server again.
 *
 * Each try is one request. Only when it is answered are the connections opened that the page
 * needs: viser's, and its own (socket.js). So a server that has gone costs a network little,
 * and its proxy few lines of a log; after some minutes the page asks only when its user, or
 * the network, gives a reason to. viser itself would ask once a second for ever, as long as
 * its page has the focus; viser_address.js keeps it from that. */

/** How long the page waits before each try, the last one again and again [ms]. */
export const WAITS = [100, 1000, 2000, 5000, 15_000, 30_000];
/** It asks no more by itself after so long [ms]. */
export const PATIENCE = 5 * 60_000;
/** A request that is not answered after so long is a failed try [ms]. */
const ANSWER = 10_000;
/** A connection that opens for so long is opened again, also when it seems to be there [ms]. */
const HANGS = 6000;

/**
 * One of the connections that a page needs.
 * @typedef {{ready: boolean, opening: boolean, open: () => void}} Part ready: it works;
 *   opening: it was opened, and may still come
 * @typedef {{tries: number, waited: number, status: number, ended: boolean}} State tries: since
 *   the connection was lost; waited: between them [ms], whatever a clock says that may be set
 *   meanwhile; status: of the last answer, 0 for none; ended: the page asks no more by itself
 */

export class Retries {
  /** @param {() => Promise<number>} ask asks the server; the status of its answer, 0 for none */
  constructor(ask) {
    this.ask = ask;
    /** @type {Part[]} */
    this.parts = [];
    /** Hear how the tries go. @type {((state: State) => void)[]} */
    this.listeners = [];
    /** @type {State | null} */
    this.state = null;
    /** @type {ReturnType<typeof setTimeout> | undefined} */
    this.timer = undefined;
    this.left = false;
    /** A try waits longer by up to so much, by chance: the pages of a server that has ended
     * do not all come to another one at once [ms]. */
    this.spread = 0;
  }

  /** A part has lost its connection, or did not get one: try again from now on. */
  lost() {
    if (this.state || this.left) return;
    this.begin();
    this.wait();
  }

  begin() {
    this.state = { tries: 0, waited: 0, status: 0, ended: false };
  }

  /** A part is ready; when all are, there is nothing to try. */
  back() {
    if (!this.parts.every((part) => part.ready)) return;
    clearTimeout(this.timer);
    this.state = null;
  }

  /** Try at once. @param {boolean} [afresh] and then as if the connection was lost now */
  now(afresh = true) {
    if (!this.state || this.left) return;
    clearTimeout(this.timer);
    if (afresh) this.begin();
    this.try();
  }

  wait() {
    const { state } = this;
    if (!state || this.left) return;
    const wait = WAITS[Math.min(state.tries, WAITS.length - 1)];
    state.waited += wait;
    state.ended = state.waited > PATIENCE;
    for (const listener of this.listeners) listener(state);
    clearTimeout(this.timer);
    if (!state.ended) this.timer = setTimeout(() => this.try(), wait + this.spread * Math.random());
  }

  async try() {
    const { state } = this;
    if (!state) return;
    state.tries += 1;
    const status = await this.ask();
    // Meanwhile the connection may be back, or another try may have begun.
    if (this.state !== state || this.left) return;
    if (status === 200) {
      // It is there again: what does not get through now may do so soon.
      if (state.status !== 200) state.tries = 1;
      const hangs = state.tries > 2 && state.waited > HANGS;
      for (const part of this.parts) if (!part.opening && (!part.ready || hangs)) part.open();
    }
    state.status = status;
    this.wait();
  }

  /** Try no more: the page has to be loaded again. */
  leave() {
    this.left = true;
    clearTimeout(this.timer);
  }
}

/** Ask the server for its page, which the browser has already. @returns {Promise<number>} */
const askForPage = () =>
  fetch("./", { cache: "no-cache", signal: AbortSignal.timeout(ANSWER) }).then(
    (answer) => answer.status,
    () => 0,
  );

export const retries = new Retries(askForPage);

/** viser's connection, which viser_address.js watches, or viser_socket.js opens. @returns {Part} */
function viserPart() {
  const viser = /** @type {NonNullable<typeof window.sambotViser>} */ (window.sambotViser);
  viser.changed = (state) => (state === "open" ? retries.back() : retries.lost());
  return {
    get ready() {
      return viser.state === "open";
    },
    get opening() {
      return viser.state === "opening";
    },
    open: viser.open,
  };
}

if (globalThis.window?.sambotViser) {
  retries.parts.push(viserPart());
  if (window.sambotViser?.state === "closed") retries.lost();
  // After a change of networks, or when a user looks again, nobody has to wait for a turn.
  addEventListener("online", () => retries.now());
  document.addEventListener("visibilitychange", () => {
    if (document.visibilityState === "visible") retries.now(false);
  });
}

// A server's end of the page's websocket, for tests without a browser.

/** What the page has sent, as it is after JSON. @type {any[]} */
export const received = [];
/** All sockets that were opened. @type {FakeSocket[]} */
export const opened = [];

export class FakeSocket {
  /** @param {string} address @param {string[]} protocols */
  constructor(address, protocols) {
    Object.assign(this, { address, protocols });
    opened.push(this);
  }
  /** @param {string} text */
  send(text) {
    if (text !== '"ping"') received.push(JSON.parse(text));
    else this.pings += 1;
  }
  /** @param {number} [code] */
  close(code) {
    this.code = code;
  }
  pings = 0;
  /** @type {number | undefined} */
  code = undefined;
  /** @param {{code?: number}} [event] */
  onclose(event) {
    void event;
  }
  /** @param {{data: any}} event */
  onmessage(event) {
    void event;
  }
}

/** The socket that the page uses now. */
export const last = () => /** @type {FakeSocket} */ (opened[opened.length - 1]);

/** Have the server send something, and the page take it. @param {any} message */
export async function say(message) {
  last().onmessage({ data: message instanceof ArrayBuffer ? message : JSON.stringify(message) });
  await new Promise((done) => setImmediate(done));
}

Object.assign(globalThis, {
  WebSocket: FakeSocket,
  window: { sambotSocket: "ws://server/?ticket=1" },
  document: { addEventListener() {}, visibilityState: "visible" },
  addEventListener() {},
  // The page asks whether the server is there.
  fetch: async () => ({ status: 200 }),
});

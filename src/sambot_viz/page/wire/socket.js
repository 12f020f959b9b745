// @ts-check
/* The page's own websocket, beside viser's: messages in, edits out, and whether it is there.
 *
 * Its address names the ticket of the page (address.js), as that of viser does: so the server
 * knows that both belong to one client. The server closes it when viser's connection ends.
 */

import { PICTURE, unpacked } from "./pictures.js";
import { retries } from "./retries.js";

const SUBPROTOCOL = "sambot-viz-1";
/** How often the page asks whether the server is there [ms]. */
const HEARTBEAT = 10_000;
/** How long it may take to answer [ms]. */
const ANSWER = 5000;
/** The page closes its connections for good. */
const PAGE_LEFT = 4002;

/** The presenter has closed this page. */
const REMOVED = 4003;
/** The server stops, perhaps to be started again. */
const STOPS = 1012;

/** @typedef {{take: (message: any) => void, lost: () => void, removed: () => void, stops: () => void}} Follower */

export class Socket {
  /**
   * @param {string} address
   * @param {Follower} follower takes messages, and hears when the connection is lost, or was
   *   ended by the presenter, or that the server stops
   */
  constructor(address, follower) {
    this.address = address;
    this.follower = follower;
    /** Whether messages have come: the server knows the page, and takes its edits. */
    this.ready = false;
    /** How often the server was heard: a clock may be set meanwhile. */
    this.heard = 0;
    /** @type {WebSocket | null} */
    this.socket = null;
    retries.parts.push(this);
    this.open();
    setInterval(() => this.ask(), HEARTBEAT);
    // After a sleep or a change of networks the page need not wait for its turn.
    addEventListener("online", () => this.ask());
    document.addEventListener("visibilitychange", () => {
      if (document.visibilityState === "visible") this.ask();
    });
  }

  /** Whether there is a connection that may still bring the first message. */
  get opening() {
    return this.socket !== null && !this.ready;
  }

  open() {
    this.drop();
    const socket = new WebSocket(this.address, [SUBPROTOCOL]);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    // Messages are taken in their order; one that has to be unpacked holds up the others.
    let last = Promise.resolve();
    socket.onmessage = ({ data }) => {
      this.heard += 1;
      last = last
        .then(async () => {
          const message = await decoded(data);
          if (this.socket === socket && message !== "pong") this.take(message);
        })
        // An error in one message must not keep the next ones from being taken.
        .catch((error) => reportError(error));
    };
    socket.onclose = ({ code }) => {
      // One that was given up may end much later.
      if (this.socket !== socket) return;
      if (code === STOPS) this.follower.stops();
      if (code !== REMOVED) return this.end();
      this.leave();
      this.follower.removed();
    };
  }

  /** @param {any} message */
  take(message) {
    if (!this.ready) {
      this.ready = true;
      retries.back();
    }
    this.follower.take(message);
  }

  /** The connection is lost, or did not come. */
  end() {
    this.drop();
    retries.lost();
  }

  /** Have no connection. */
  drop() {
    const was = this.ready;
    this.socket?.close();
    this.socket = null;
    this.ready = false;
    if (was) this.follower.lost();
  }

  /** Ask whether the server is there, and give the connection up when it does not answer. */
  ask() {
    const { socket, heard } = this;
    if (!socket || !this.ready) return;
    const at = Date.now();
    socket.send('"ping"');
    setTimeout(() => {
      if (this.socket !== socket || this.heard !== heard) return;
      // This timer ran late, perhaps after a sleep: what has come meanwhile was not read yet.
      if (Date.now() - at > 2 * ANSWER) return this.ask();
      this.end();
    }, ANSWER);
  }

  /** Send a message, if there is a connection. @param {any} message */
  send(message) {
    if (this.ready) this.socket?.send(JSON.stringify(message));
  }

  /** End all connections of this page for good: it has to be loaded again. */
  leave() {
    const { socket } = this;
    this.socket = null;
    this.ready = false;
    retries.leave();
    socket?.close(PAGE_LEFT);
  }
}

/** What a frame says: JSON, in a binary frame behind its kind, or a picture. @param {string | ArrayBuffer} data */
async function decoded(data) {
  if (typeof data === "string") return JSON.parse(data);
  const [kind] = new Uint8Array(data, 0, 1);
  if (kind === PICTURE) return { picture: unpacked(data) };
  if (kind !== 1) throw new Error(`unknown kind of frame: ${kind}`);
  const packed = new Blob([new Uint8Array(data, 1)]).stream();
  return new Response(packed.pipeThrough(new DecompressionStream("gzip"))).json();
}

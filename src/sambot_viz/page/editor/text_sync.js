// @ts-check
/* One text in the page and on the server: what is typed here goes there in pieces, and what
 * others have written comes in between, with what is typed meanwhile kept. */

/** Longest piece that a message has [UTF-16 units]; the server's limit is the same. */
const PIECE = 10_000;

/**
 * @typedef {any} ChangeSet of CodeMirror
 * @typedef {{version: number, from: number, to: number, text: string, more: boolean}} Piece
 */

export class TextSync {
  /**
   * @param {{of: (changes: any, length: number) => ChangeSet}} sets makes changes: CodeMirror's
   *   `ChangeSet`
   * @param {string} text as the server has it @param {number} version of it
   */
  constructor(sets, text, version) {
    this.sets = sets;
    this.version = version;
    /** What the server has. */
    this.known = text;
    /** What is here. */
    this.text = text;
    /** What was sent and is not there yet, as one replacement. @type {Sent | null} */
    this.sent = null;
    /** All that was typed since `known`. @type {ChangeSet | null} */
    this.typed = null;
  }

  /** Whether the server lacks something of the text. */
  get isAhead() {
    return this.text !== this.known;
  }

  /** Note what was typed. @param {ChangeSet} changes @param {string} text with them */
  type(changes, text) {
    this.typed = this.typed ? this.typed.compose(changes) : changes;
    this.text = text;
  }

  /** What is to be sent now: nothing while something is on its way. @returns {Piece[]} */
  pieces() {
    if (this.sent || !this.isAhead) return [];
    const { from, to, text } = replacement(this.known, this.text);
    const parts = split(text);
    this.sent = { from, to, parts, text: this.text };
    let at = from;
    return parts.map((part, number) => {
      const end = number ? at : to;
      const more = number < parts.length - 1;
      const piece = { version: this.version + number, from: at, to: end, text: part, more };
      at += part.length;
      return piece;
    });
  }

  /** What was sent was not taken, or may be lost: it is to be sent again. */
  forget() {
    this.sent = null;
  }

  /**
   * Take the text that the server has.
   * @param {number} version @param {string} text
   * @returns {ChangeSet | null} what others have changed, for the text here
   */
  take(version, text) {
    const sent = this.sent;
    const steps = version - this.version;
    if (sent && text === sent.text) return this.reach(version, text);
    if (sent && steps > 0 && steps < sent.parts.length && text === partly(this.known, sent, steps))
      return null;
    this.sent = null;
    if (text === this.text) return this.reach(version, text);
    if (text === this.known) {
      this.version = version;
      return null;
    }
    const { from, to, text: insert } = replacement(this.known, text);
    const others = this.sets.of({ from, to, insert }, this.known.length);
    const here = this.typed ? others.map(this.typed, true) : others;
    if (this.typed) this.typed = this.typed.map(others);
    this.known = text;
    this.version = version;
    return here;
  }

  /** The server has what was sent. @param {number} version @param {string} text */
  reach(version, text) {
    this.known = text;
    this.version = version;
    this.sent = null;
    const left = replacement(text, this.text);
    this.typed = this.isAhead
      ? this.sets.of({ from: left.from, to: left.to, insert: left.text }, text.length)
      : null;
    return null;
  }
}

/** @typedef {{from: number, to: number, parts: string[], text: string}} Sent */

/** The text when some of the pieces have come. @param {string} known @param {Sent} sent
 * @param {number} steps */
const partly = (known, { from, to, parts }, steps) =>
  known.slice(0, from) + parts.slice(0, steps).join("") + known.slice(to);

/** The one replacement that makes a text of another. @param {string} before @param {string} after */
export function replacement(before, after) {
  const shortest = Math.min(before.length, after.length);
  let from = 0;
  while (from < shortest && before.charCodeAt(from) === after.charCodeAt(from)) from++;
  if (isHalf(before, from) || isHalf(after, from)) from--;
  let end = 0;
  while (
    end < shortest - from &&
    before.charCodeAt(before.length - 1 - end) === after.charCodeAt(after.length - 1 - end)
  )
    end++;
  if (isHalf(before, before.length - end) || isHalf(after, after.length - end)) end--;
  return { from, to: before.length - end, text: after.slice(from, after.length - end) };
}

/** Whether a place is within a character. @param {string} text @param {number} at */
const isHalf = (text, at) => at > 0 && (text.charCodeAt(at) & 0xfc00) === 0xdc00;

/** @param {string} text */
function split(text) {
  const parts = [];
  for (let at = 0; at < text.length;) {
    let end = Math.min(at + PIECE, text.length);
    if (end < text.length && isHalf(text, end)) end--;
    parts.push(text.slice(at, end));
    at = end;
  }
  return parts.length ? parts : [""];
}

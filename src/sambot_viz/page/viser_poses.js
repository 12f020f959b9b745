// @ts-check
/* Takes apart what the server says of poses that move (viser_private/moving_poses.py). viser sees
 * its own messages only: those that tell a pose first have a number, and all that has moved since
 * comes as one message of numbers and values.
 * This runs before viser, not as a module: a message that was missed would not come again. */

{
  /** The name in a message with what has moved. */
  const MOVED = "~";
  /** By number, the message for what has moved, without its value. @type {Map<number, any>} */
  const tracks = new Map();
  /** The number of each rotation and position. @type {Map<string, number>} */
  const numbers = new Map();

  /** @param {string} type @param {any} message about a node */
  const keyOf = (type, { name, owner }) => `${type} ${owner} ${name}`;

  /** Remember what a number means. @param {any} message */
  function note({ type, name, owner, number }) {
    const key = keyOf(type, { name, owner });
    forget(key);
    numbers.set(key, number);
    tracks.set(number, { type, name, owner });
  }

  /** @param {string} key */
  function forget(key) {
    const number = numbers.get(key);
    if (number !== undefined) tracks.delete(number);
    numbers.delete(key);
  }

  /** Numbers in seven bits a byte, the lowest first, up to a 0; and where they end.
   * @param {Uint8Array} content */
  function numbersOf(content) {
    const found = [];
    let at = 0;
    for (;;) {
      let number = 0,
        scale = 1,
        byte;
      do {
        byte = content[at++];
        number += (byte & 127) * scale;
        scale *= 128;
      } while (byte > 127);
      if (!number) return { numbers: found, at };
      found.push(number);
    }
  }

  /** The messages of viser for what has moved.
   * @param {Uint8Array} content the number of each, 0, and the values (64 bits)
   * @returns {any[]} */
  function moved(content) {
    const view = new DataView(content.buffer, content.byteOffset, content.byteLength);
    const known = numbersOf(content),
      messages = [];
    let { at } = known;
    for (const number of known.numbers) {
      const isPosition = number % 2 === 1;
      const value = [];
      for (const end = at + (isPosition ? 24 : 32); at < end; at += 8)
        value.push(view.getFloat64(at, true));
      const track = tracks.get(number);
      if (track) messages.push({ ...track, [isPosition ? "position" : "wxyz"]: value });
    }
    return messages;
  }

  /** What viser gets of messages that have come. @param {any[]} messages */
  function unpacked(messages) {
    if (!messages.some(({ name, number }) => name === MOVED || number !== undefined))
      return messages;
    return messages.flatMap((message) => {
      if (message.name === MOVED) return moved(message.position);
      if (message.number !== undefined) note(message);
      return [message];
    });
  }

  window.sambotPoses = {
    unpacked,
    /** Another connection tells all again. */
    clear() {
      tracks.clear();
      numbers.clear();
    },
  };
}

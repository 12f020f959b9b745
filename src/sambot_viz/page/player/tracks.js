// @ts-check
/* What moves in a page that is a file: of each node, the values it has had. */

/**
 * @typedef {{type: string, prop: string, name: string, first: any, times: number[],
 *   values: any[], now: number}} Track
 *   type: of viser's message, empty for a node itself
 *   first: the value before the first of the times [ms]
 *   now: the number of the value that is shown; -1 for the first one, -2 when none is */

/** @type {Record<string, any>} */
const ARRAYS = {
  "<f4": Float32Array,
  "<f8": Float64Array,
  "|u1": Uint8Array,
  "<u2": Uint16Array,
  "<u4": Uint32Array,
  "|i1": Int8Array,
  "<i2": Int16Array,
  "<i4": Int32Array,
  "<f2": Uint16Array,
};

/** @param {string} text @returns {Uint8Array<ArrayBuffer>} */
const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));

/** A value in which arrays are arrays again. @param {any} value @returns {any} */
function whole(value) {
  if (Array.isArray(value)) return value.map(whole);
  if (!value || typeof value !== "object") return value;
  if ("base64" in value) return new ARRAYS[value.dtype](bytes(value.base64).buffer);
  return Object.fromEntries(Object.entries(value).map(([key, part]) => [key, whole(part)]));
}

/** Read tracks from base64 of gzipped JSON. @param {string} packed @returns {Promise<Track[]>} */
export async function read(packed) {
  const stream = new Blob([bytes(packed)]).stream().pipeThrough(new DecompressionStream("gzip"));
  return unpack(await new Response(stream).json());
}

/** @param {any[]} tracks with the times since the value before @returns {Track[]} */
export function unpack(tracks) {
  return tracks.map(({ since, first, values, ...track }) => {
    let time = 0;
    const times = since.map((/** @type {number} */ more) => (time += more));
    return { ...track, first: whole(first), values: values.map(whole), times, now: -1 };
  });
}

/**
 * The number of the last value at a time; -1 before all of them.
 * @param {number[]} times
 * @param {number} time
 */
function last(times, time) {
  let low = -1;
  let high = times.length - 1;
  while (low < high) {
    const middle = Math.ceil((low + high) / 2);
    if (times[middle] <= time) low = middle;
    else high = middle - 1;
  }
  return low;
}

/**
 * The messages of viser that bring all nodes to a time, from where they are.
 * @param {Track[]} tracks they take note of it @param {number} time [ms] @returns {any[]}
 */
export function at(tracks, time) {
  /** @type {any[]} */
  const messages = [];
  /** The nodes that are not there at this time. @type {Set<string>} */
  const gone = new Set();
  // A node comes before what is set of it.
  for (const track of tracks) if (!track.type) step(track);
  for (const track of tracks) if (track.type && !gone.has(track.name)) step(track);
  return messages;

  /** @param {Track} track */
  function step(track) {
    const to = last(track.times, time);
    const { type, name, prop } = track;
    const value = to < 0 ? track.first : track.values[to];
    if (!type && !value) gone.add(name);
    if (to === track.now) return;
    track.now = to;
    if (!type) {
      for (const other of tracks) if (other.type && other.name === name) other.now = -2;
      messages.push(value || { type: "RemoveSceneNodeMessage", name, owner: "" });
    } else if (value !== null && value !== undefined) {
      messages.push(
        type === "SceneNodeUpdateMessage"
          ? { type, name, owner: "", updates: { [prop]: value } }
          : { type, name, owner: "", [prop]: value },
      );
    }
  }
}

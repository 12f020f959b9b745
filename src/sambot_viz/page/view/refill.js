// @ts-check
/* Files that come again for a node which draws points (points.js): what is drawn already gets the
 * places and colours of the new one, where they are. viser would read each as a new object, with
 * buffers on the graphics card of its own, and for some pictures there would be none.
 *
 * A file that looks otherwise in any way is viser's.
 */

/** "glTF". */
const MAGIC = 0x46546c67;
/** Before the document of a GLB file, and before what follows it. */
const HEADER = 20,
  CHUNK = 8;
/** More room than is needed, for the next ones that are a little larger. */
const ROOM = 1.25;
const text = new TextDecoder();

/** What a file says: its document, and the bytes of an accessor. @param {Uint8Array} file */
function read(file) {
  if (file.length < HEADER) return null;
  const view = new DataView(file.buffer, file.byteOffset, file.byteLength);
  if (view.getUint32(0, true) !== MAGIC) return null;
  const begin = HEADER + view.getUint32(12, true);
  const document = JSON.parse(text.decode(file.subarray(HEADER, begin)));
  /** @param {number} accessor */
  const bytesOf = (accessor) => {
    const { byteOffset, byteLength } =
      document.bufferViews[document.accessors[accessor].bufferView];
    const at = begin + CHUNK + byteOffset;
    return file.subarray(at, at + byteLength);
  };
  return { document, bytesOf };
}

/** Whether a file differs from what is drawn in its numbers alone.
 * @param {any} object @param {any} document */
function looksLike({ userData, material, geometry }, { meshes, materials }) {
  const [{ extras, primitives }] = meshes;
  const names = new Set([...Object.keys(extras), "color"]);
  for (const name of names)
    if (JSON.stringify(extras[name]) !== JSON.stringify(userData[name])) return false;
  const isBlended = materials[0].alphaMode === "BLEND";
  const hasColors = primitives[0].attributes.COLOR_0 !== undefined;
  return isBlended === material.transparent && hasColors === "tint" in geometry.attributes;
}

/** @param {any} geometry @param {string} name @param {Uint8Array} bytes */
function put(geometry, name, bytes) {
  let attribute = geometry.attributes[name];
  if (attribute.array.byteLength < bytes.length) {
    const { array, itemSize, normalized } = attribute;
    const rows = Math.ceil((ROOM * bytes.length) / (itemSize * array.BYTES_PER_ELEMENT));
    // What is on the card keeps its size.
    geometry.dispose();
    attribute = new attribute.constructor(
      new array.constructor(rows * itemSize),
      itemSize,
      normalized,
    );
    Object.assign(attribute, { isInstancedBufferAttribute: true, meshPerAttribute: 1 });
    geometry.setAttribute(name, attribute);
  }
  const { buffer, byteOffset, byteLength } = attribute.array;
  new Uint8Array(buffer, byteOffset, byteLength).set(bytes);
  attribute.needsUpdate = true;
}

/** The points that a node of viser draws; null while there are none. @param {any} node */
export function pointsOf(node) {
  // Below the scene of the file; other nodes may hang beside it.
  const drawn = node?.children?.flatMap((/** @type {any} */ { children }) => children) || [];
  const arePoints = (/** @type {any} */ { userData, geometry }) =>
    userData.drawAs === "points" && geometry?.attributes.center;
  return drawn.find(arePoints) || null;
}

/**
 * What gives points other places and colours; null if viser has to read the file.
 * @param {any} object of points.js
 * @param {Uint8Array} file
 * @returns {(() => void) | null}
 */
export function refilling(object, file) {
  const found = read(file);
  if (!found || !looksLike(object, found.document)) return null;
  const { document, bytesOf } = found;
  const { POSITION, COLOR_0 } = document.meshes[0].primitives[0].attributes;
  return () => {
    const { geometry } = object;
    put(geometry, "center", bytesOf(POSITION));
    if (COLOR_0 !== undefined) put(geometry, "tint", bytesOf(COLOR_0));
    geometry.instanceCount = document.accessors[POSITION].count;
  };
}

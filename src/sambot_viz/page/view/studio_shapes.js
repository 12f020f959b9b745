// @ts-check
/* Studio: round shapes in place of those with 16 flat sides, and smooth meshes. The server sends
 * RViz's shapes to all; here the geometry of an object is replaced while its page shows Studio. */

const SIDES = 32;
/** Axes and arrows are thin. */
const FEW_SIDES = 16;
/** Faces that meet at less than this are one smooth surface [cosine of 35°]. */
const CREASE = 0.82;
/** Of more faces around one corner, as in the middle of a disc, those that look alike are one. */
const MANY = 48;
/** Faces look alike that differ by less than this [cosine of 3°]. */
const ALIKE = 0.9986;
/** Meshes with more triangles stay as they are. */
const MOST_TRIANGLES = 120000;
/** At most so long a picture waits for meshes to be made smooth; the next one goes on [ms]. */
const LONGEST = 40;

/** What an object had before. @type {WeakMap<object, {geometry: any, flat: boolean}>} */
const before = new WeakMap();
/** Of each geometry that was seen: what takes its place, or null. @type {WeakMap<object, any>} */
const instead = new WeakMap();

/**
 * A surface of revolution: rows from its beginning to its end on the axis, each with radius, place on
 * the axis and normal; a row that repeats the place of the one before begins a new surface.
 * @typedef {[r: number, z: number, nr: number, nz: number]} Row
 */
/** @type {Row[]} */
const CAPS = [
  [0, -0.5, 0, -1],
  [0.5, -0.5, 0, -1],
];
/** @type {Row[]} */
const CYLINDER = [...CAPS, [0.5, -0.5, 1, 0], [0.5, 0.5, 1, 0], [0.5, 0.5, 0, 1], [0, 0.5, 0, 1]];
/** As in meshes/primitives.py, a cone is not quite centred. @type {Row[]} */
const CONE = [
  [0, -0.509, 0, -1],
  [0.5, -0.509, 0, -1],
  [0.5, -0.509, 0.894, 0.447],
  [0, 0.491, 0.894, 0.447],
];
/** @type {Row[]} */
const SPHERE = Array.from({ length: SIDES / 2 + 1 }, (_, i) => {
  const angle = (Math.PI * i) / (SIDES / 2);
  const [r, z] = [Math.sin(angle), -Math.cos(angle)];
  return [r / 2, z / 2, r, z];
});

/** @param {any} geometry of three.js @returns {any} an empty one */
function fresh(geometry) {
  let kind = geometry.constructor;
  // viser's cylinder is of a class that is derived from that of all geometries.
  if (geometry.type !== "BufferGeometry") kind = Object.getPrototypeOf(kind);
  return new kind();
}

/** @param {any} geometry @param {number[] | Float32Array} positions @param {any} normals */
function filled(geometry, positions, normals) {
  const made = fresh(geometry);
  const kind = geometry.attributes.position.constructor;
  made.setAttribute("position", new kind(Float32Array.from(positions), 3));
  made.setAttribute("normal", new kind(Float32Array.from(normals), 3));
  return made;
}

/** Made anew, or by the mesh's file for one purpose. */
const NOT_KEPT = new Set(["position", "normal", "_normal"]);

/** Give a geometry what the corners of another one have besides: texture coordinates, colours.
 * @param {any} made @param {any} geometry @param {(i: number) => number} corner
 * @param {number} count of corners */
function keepRest(made, geometry, corner, count) {
  for (const [name, from] of Object.entries(geometry.attributes)) {
    if (NOT_KEPT.has(name)) continue;
    const { data, itemSize: size } = from;
    const source = data ? data.array : from.array;
    const [step, first] = data ? [data.stride, from.offset] : [size, 0];
    const values = new source.constructor(size * count);
    for (let i = 0; i < count; i += 1)
      for (let k = 0; k < size; k += 1) values[size * i + k] = source[step * corner(i) + first + k];
    const kind = data ? geometry.attributes.position.constructor : from.constructor;
    made.setAttribute(name, new kind(values, size, from.normalized));
  }
  made.groups = geometry.groups;
  return made;
}

/** @param {any} geometry @param {Row[]} rows @param {number} sides @param {boolean} alongY */
function turned(geometry, rows, sides, alongY) {
  /** @type {number[]} */
  const positions = [];
  /** @type {number[]} */
  const normals = [];
  /** @type {number[]} */
  const faces = [];
  rows.forEach(([r, z, nr, nz], row) => {
    for (let side = 0; side <= sides; side += 1) {
      const angle = (2 * Math.PI * side) / sides;
      const [c, s] = [Math.cos(angle), Math.sin(angle)];
      positions.push(r * c, ...(alongY ? [z, -r * s] : [r * s, z]));
      normals.push(nr * c, ...(alongY ? [nz, -nr * s] : [nr * s, nz]));
    }
    if (row === 0 || (rows[row - 1][0] === r && rows[row - 1][1] === z)) return;
    const at = row * (sides + 1);
    for (let a = at; a < at + sides; a += 1) {
      const under = a - sides - 1;
      faces.push(under, under + 1, a + 1, under, a + 1, a);
    }
  });
  const made = filled(geometry, positions, normals);
  made.setIndex(new geometry.index.constructor(Uint16Array.from(faces), 1));
  return made;
}

/** Whether all corners are where a test says. @param {any} geometry
 * @param {(x: number, y: number, z: number) => boolean} test */
function all(geometry, test) {
  const { position } = geometry.attributes;
  for (let i = 0; i < position.count; i += 1) {
    if (!test(position.getX(i), position.getY(i), position.getZ(i))) return false;
  }
  return true;
}
/** @param {number} a @param {number} b */
const near = (a, b) => Math.abs(a - b) < 1e-4;

/** What a round shape of RViz becomes; null for everything else. @param {any} geometry
 * @param {number} sides */
function rounded(geometry, sides) {
  const count = geometry.attributes.position?.count;
  if (geometry.type === "CylinderGeometry") {
    const { radiusTop, radiusBottom, height } = geometry.parameters;
    if (radiusTop !== radiusBottom) return null;
    const made = turned(geometry, CYLINDER, sides, true);
    made.scale(2 * radiusTop, height, 2 * radiusTop);
    return made;
  }
  // What has a texture or colours is a mesh, whatever its form.
  const { uv, color } = geometry.attributes;
  if (!geometry.index || uv || color) return null;
  if (count === 114 && all(geometry, (x, y, z) => near(Math.hypot(x, y, z), 0.5)))
    return turned(geometry, SPHERE, sides, false);
  if (count === 32 && all(geometry, (x, y, z) => near(Math.hypot(x, y), 0.5) && near(z * z, 0.25)))
    return turned(geometry, CYLINDER, sides, false);
  if (count === 17 && all(geometry, (x, y, z) => near(z, 0.491) || near(z, -0.509)))
    return turned(geometry, CONE, sides, false);
  return null;
}

/** The corners that are at the same place have the same number. @param {any} position
 * @param {(i: number) => number} corner @param {number} count */
function welded(position, corner, count) {
  const size = 2 ** Math.ceil(Math.log2(2 * count + 2));
  const table = new Int32Array(size).fill(-1);
  const number = new Int32Array(count);
  const bits = new Int32Array(3);
  const floats = new Float32Array(bits.buffer);
  const { array } = position;
  for (let i = 0; i < count; i += 1) {
    const at = 3 * corner(i);
    // Adding 0 makes -0 and 0 the same bits.
    for (let k = 0; k < 3; k += 1) floats[k] = array[at + k] + 0;
    let slot = Math.imul(bits[0], 73856093) ^ Math.imul(bits[1], 19349663);
    slot = (slot ^ Math.imul(bits[2], 83492791)) >>> 0;
    // Without its sign: a negative place in the table would be none.
    slot = ((slot ^ (slot >>> 15)) >>> 0) % size;
    for (; table[slot] >= 0; slot = (slot + 1) % size) {
      const other = 3 * corner(table[slot]);
      if (
        array[other] === array[at] &&
        array[other + 1] === array[at + 1] &&
        array[other + 2] === array[at + 2]
      )
        break;
    }
    if (table[slot] < 0) table[slot] = i;
    number[i] = table[slot];
  }
  return number;
}

/** The directions of the faces around a place: of each its unit normal, and the sum of the normals
 * of those that look so. Few faces are one each; of many, those that look alike are one.
 * @param {number[]} around one corner of each @param {Float32Array} normal @param {Float32Array} unit
 * @returns {number[]} */
function directions(around, normal, unit) {
  /** @type {number[]} */
  const found = [];
  for (const i of around) {
    const f = i - (i % 3);
    let [best, most] = [-1, around.length > MANY ? ALIKE : Infinity];
    for (let g = 0; most < Infinity && g < found.length; g += 6) {
      const cosine = unit[f] * found[g] + unit[f + 1] * found[g + 1] + unit[f + 2] * found[g + 2];
      if (cosine > most) [best, most] = [g, cosine];
    }
    if (best < 0) {
      best = found.length;
      found.push(unit[f], unit[f + 1], unit[f + 2], 0, 0, 0);
    }
    for (let k = 0; k < 3; k += 1) found[best + 3 + k] += normal[f + k];
  }
  return found;
}

/** A mesh of flat triangles with a normal for each corner that is smooth over all faces around it
 * but those beyond an edge. @param {any} geometry */
function smoothed(geometry) {
  const { position } = geometry.attributes;
  const index = geometry.index?.array;
  const count = index ? index.length : position?.count;
  if (!position?.array || position.isInterleavedBufferAttribute || count < 3) return null;
  if (count > 3 * MOST_TRIANGLES) return null;
  const corner = /** @param {number} i */ (i) => (index ? index[i] : i);
  const positions = new Float32Array(3 * count);
  for (let i = 0; i < count; i += 1)
    for (let k = 0; k < 3; k += 1) positions[3 * i + k] = position.array[3 * corner(i) + k];
  // Of each face its normal, as long as twice its area.
  const normal = new Float32Array(count);
  const unit = new Float32Array(count);
  for (let f = 0; f < count; f += 3) {
    const [a, b, c] = [3 * f, 3 * f + 3, 3 * f + 6];
    const [ux, uy, uz] = [0, 1, 2].map((k) => positions[b + k] - positions[a + k]);
    const [vx, vy, vz] = [0, 1, 2].map((k) => positions[c + k] - positions[a + k]);
    normal.set([uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx], f);
    const long = Math.hypot(normal[f], normal[f + 1], normal[f + 2]) || 1;
    for (let k = 0; k < 3; k += 1) unit[f + k] = normal[f + k] / long;
  }
  const number = welded(position, corner, count);
  // The corners at each place, one after the other.
  const next = new Int32Array(count).fill(-1);
  const first = new Int32Array(count).fill(-1);
  for (let i = 0; i < count; i += 1) {
    next[i] = first[number[i]];
    first[number[i]] = i;
  }
  const normals = new Float32Array(3 * count);
  /** @type {number[]} */
  const around = [];
  for (let place = 0; place < count; place += 1) {
    if (number[place] !== place) continue;
    around.length = 0;
    for (let j = first[place]; j >= 0; j = next[j]) around.push(j);
    const faces = directions(around, normal, unit);
    for (const i of around) {
      const f = i - (i % 3);
      let [x, y, z] = [0, 0, 0];
      for (let g = 0; g < faces.length; g += 6) {
        const cosine = unit[f] * faces[g] + unit[f + 1] * faces[g + 1] + unit[f + 2] * faces[g + 2];
        if (cosine < CREASE) continue;
        x += faces[g + 3];
        y += faces[g + 4];
        z += faces[g + 5];
      }
      const long = Math.hypot(x, y, z);
      // A face without an area has no direction of its own.
      normals.set(long ? [x / long, y / long, z / long] : [0, 0, 1], 3 * i);
    }
  }
  return keepRest(filled(geometry, positions, normals), geometry, corner, count);
}

let until = 0;
let waiting = 0;
/** A new picture begins. */
export function beginShapes() {
  until = performance.now() + LONGEST;
  waiting = 0;
}
/** How many meshes are not smooth yet. */
export const waitingShapes = () => waiting;

/** What takes the place of an object's geometry; null for itself. @param {any} object */
function better(object) {
  const { geometry } = object;
  const known = instead.get(geometry);
  if (known !== undefined) return known;
  let made = rounded(geometry, object.isInstancedMesh ? FEW_SIDES : SIDES);
  if (!made && !object.isInstancedMesh && geometry.type === "BufferGeometry") {
    if (performance.now() > until) {
      waiting += 1;
      return null;
    }
    made = smoothed(geometry);
  }
  instead.set(geometry, made);
  return made;
}

/** Round a lit object. @param {any} object */
export function roundOff(object) {
  const { geometry, material } = object;
  if (!geometry?.attributes?.position || !material.flatShading) return;
  const made = better(object);
  if (!made) return;
  before.set(object, { geometry, flat: true });
  // A batch keeps its own numbers in its geometry.
  object.geometry = object.isInstancedMesh ? made.clone() : made;
  material.flatShading = false;
  material.needsUpdate = true;
}

/** Give an object back what it had. @param {any} object */
export function putBack(object) {
  const had = before.get(object);
  if (!had) return;
  before.delete(object);
  if (object.isInstancedMesh) {
    // The numbers of its instances are the batch's, and would go with the geometry.
    object.geometry.deleteAttribute("instanceIndex");
    object.geometry.dispose();
  }
  object.geometry = had.geometry;
  object.material.flatShading = had.flat;
  object.material.needsUpdate = true;
}

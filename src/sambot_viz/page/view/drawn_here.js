// @ts-check
/* What a page draws in its own view, from what it has: the link of a joint whose row is pointed at
 * glows, with a needle along its axis, thick at the positive end; and the robot in another pose, as
 * a ghost. The server draws nothing of it. */

/** @typedef {[string, number, number, number]} Place node of the link, and the axis there */
/** @typedef {{root: string, links: Record<string, number[]>}} Ghost root: node of the root link;
 *   links: x y z and w x y z of each link there, by its node */

const COLOR = 0xffaa00,
  GHOST = 0x55aaff;
/** How opaque they are. */
const GLOW = 0.45,
  FAINT = 0.35;
/** Length of the needle, and its thickness, as parts of what is seen from top to bottom there. */
const LENGTH = 0.36,
  THICK = 0.005;
/** A ghost of more meshes would make each picture slow. */
const MOST = 1500;
/** The nodes of visual shapes, and of collision shapes, below the node of a link. */
const VISUAL = /^\/~[0-9a-z]*_v\d[^/]*$/,
  SHAPE = /^\/~[0-9a-z]*_[vc]\d[^/]*$/;

/** @type {{glow: any[], ghost: any[]}} */
const drawn = { glow: [], ghost: [] };

/** The classes of three.js, those of viser's crosshair. @returns {any} */
function classes() {
  /** @type {any} */
  let ball;
  window.__viserMutable?.scene.traverse((/** @type {any} */ object) => {
    if (object.isMesh && object.geometry?.type === "SphereGeometry" && !object.isInstancedMesh)
      if (object.material?.isMeshBasicMaterial) ball ||= object;
  });
  return ball;
}

/** @param {"glow" | "ghost"} which */
function clear(which) {
  for (const mesh of drawn[which]) {
    mesh.removeFromParent();
    mesh.material?.dispose();
  }
  drawn[which] = [];
}

/** The name of a node, from its last part. @param {any} page @param {string} node */
const pathOf = (page, node) =>
  node && Object.keys(page.nodeRefFromName).find((name) => name.endsWith(`/${node}`));

/** The meshes of the shapes of a link. @param {any} page @param {string} path @param {RegExp} kind */
function meshesOf(page, path, kind) {
  /** @type {any[]} */
  const meshes = [];
  for (const [name, shape] of Object.entries(page.nodeRefFromName))
    if (name.startsWith(path) && kind.test(name.slice(path.length)))
      /** @type {any} */ (shape)?.traverse((/** @type {any} */ one) => {
        if (one.isMesh && !one.isInstancedMesh && !drawn.glow.includes(one)) meshes.push(one);
      });
  return meshes;
}

/** @param {any} ball @param {any} geometry @param {any} parent @param {Record<string, any>} look */
function add(ball, geometry, parent, look) {
  const material = new ball.material.constructor({ transparent: true, toneMapped: false, ...look });
  const mesh = new ball.constructor(geometry, material);
  mesh.raycast = () => undefined;
  mesh.renderOrder = 10;
  parent.add(mesh);
  return mesh;
}

/** Light a joint, or none. @param {Place} [place] */
export function glow(place) {
  const page = window.__viserMutable;
  if (!page || (!place && !drawn.glow.length)) return;
  clear("glow");
  if (place) light(page, place);
  page.requestRender?.();
}

/** @param {any} page @param {Place} place */
function light(page, [node, ...axis]) {
  const path = pathOf(page, node);
  const link = path && page.nodeRefFromName[path];
  const ball = classes();
  if (!link || !ball) return;
  const over = { color: COLOR, opacity: GLOW, depthWrite: false, polygonOffset: true };
  for (const mesh of meshesOf(page, path, SHAPE)) {
    const nearer = { polygonOffsetFactor: -1, polygonOffsetUnits: -1 };
    drawn.glow.push(add(ball, mesh.geometry, mesh, { ...over, ...nearer }));
  }
  if (!axis.some(Boolean)) return;
  const at = link.getWorldPosition(ball.position.clone());
  const far = at.distanceTo(page.camera.getWorldPosition(at.clone()));
  // Views without perspective are those of a camera far away that sees a small angle.
  const seen = 2 * far * Math.tan((page.camera.fov * Math.PI) / 360);
  const along = at
    .clone()
    .set(...axis)
    .normalize();
  const round = new ball.geometry.constructor(0.5, 16, 8);
  /** @param {number} middle @param {number[]} size as parts of what is seen */
  const part = (middle, size) => {
    const mesh = add(ball, round, link, { color: COLOR, depthTest: false });
    drawn.glow.push(mesh);
    mesh.position.copy(along).multiplyScalar(middle * seen);
    mesh.quaternion.setFromUnitVectors(at.clone().set(0, 0, 1), along);
    mesh.scale.set(...size.map((length) => length * seen));
  };
  part(0, [THICK, THICK, LENGTH]);
  part(LENGTH / 2, [4 * THICK, 4 * THICK, 6 * THICK]);
}

/**
 * Draw the ghost of a pose, or none.
 * @param {Ghost} [ghost] @returns {string} why it is not drawn
 */
export function haunt(ghost) {
  const page = window.__viserMutable;
  if (!page || (!ghost && !drawn.ghost.length)) return "";
  clear("ghost");
  page.requestRender?.();
  const ball = ghost && classes();
  const root = ghost && page.nodeRefFromName?.[pathOf(page, ghost.root) || ""];
  if (!ball || !root) return "";
  const parts = Object.entries(ghost.links).flatMap(([node, pose]) => {
    const path = pathOf(page, node);
    const link = path && page.nodeRefFromName?.[path];
    return link ? [{ link, pose, meshes: meshesOf(page, path, VISUAL) }] : [];
  });
  const count = parts.reduce((sum, { meshes }) => sum + meshes.length, 0);
  if (count > MOST) return `This robot has ${count} meshes: a ghost may have ${MOST}`;
  root.updateWorldMatrix(true, true);
  for (const { link, pose, meshes } of parts) {
    const group = new root.constructor();
    const [w, x, y, z] = pose.slice(3);
    group.position.set(...pose.slice(0, 3));
    group.quaternion.set(x, y, z, w);
    root.add(group);
    drawn.ghost.push(group);
    const toLink = link.matrixWorld.clone().invert();
    for (const mesh of meshes) {
      const look = { color: GHOST, opacity: FAINT, depthWrite: false };
      const copy = add(ball, mesh.geometry, group, look);
      copy.matrixAutoUpdate = false;
      copy.matrix.multiplyMatrices(toLink, mesh.matrixWorld);
      drawn.ghost.push(copy);
    }
  }
  return "";
}

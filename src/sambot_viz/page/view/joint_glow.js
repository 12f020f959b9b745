// @ts-check
/* The joint whose row is pointed at: its link glows in this page's view, and a needle shows its
 * axis, thick at the positive end. The server hears nothing of it. */

/** @typedef {[string, number, number, number]} Place node of the link, and the axis there */

const COLOR = 0xffaa00;
/** How opaque the glow is. */
const GLOW = 0.45;
/** Length of the needle, and its thickness, as parts of the distance from the camera. */
const LENGTH = 0.3,
  THICK = 0.004;
/** The nodes of visual and collision shapes below the node of a link. */
const SHAPE = /^\/~[0-9a-z]*[vc]\d[^/]*$/;

/** What is drawn now. @type {any[]} */
let drawn = [];

/** The classes of three.js, those of viser's crosshair. @returns {any} */
function classes() {
  let ball;
  window.__viserMutable?.scene.traverse((/** @type {any} */ object) => {
    if (object.isMesh && object.geometry?.type === "SphereGeometry" && !object.isInstancedMesh)
      if (object.material?.isMeshBasicMaterial) ball ||= object;
  });
  return ball;
}

/** Show a joint, or none. @param {Place} [place] */
export function glow(place) {
  const page = window.__viserMutable;
  if (!page || (!place && !drawn.length)) return;
  for (const mesh of drawn) {
    mesh.removeFromParent();
    mesh.material.dispose();
  }
  drawn = [];
  if (place?.[0]) show(page, place);
  page.requestRender?.();
}

/** @param {any} page @param {Place} place */
function show(page, [node, ...axis]) {
  const path = Object.keys(page.nodeRefFromName).find((name) => name.endsWith(`/${node}`));
  const link = path && page.nodeRefFromName[path];
  const ball = classes();
  if (!link || !ball) return;
  /** @param {any} geometry @param {any} parent @param {Record<string, any>} more */
  const add = (geometry, parent, more) => {
    const material = new ball.material.constructor({ color: COLOR, toneMapped: false, ...more });
    const mesh = new ball.constructor(geometry, material);
    mesh.raycast = () => undefined;
    mesh.renderOrder = 10;
    parent.add(mesh);
    drawn.push(mesh);
    return mesh;
  };
  for (const [name, shape] of Object.entries(page.nodeRefFromName)) {
    if (!name.startsWith(path) || !SHAPE.test(name.slice(path.length))) continue;
    /** @type {any[]} */
    const meshes = [];
    /** @type {any} */ (shape)?.traverse((/** @type {any} */ one) => {
      if (one.isMesh && !one.isInstancedMesh) meshes.push(one);
    });
    const over = { transparent: true, opacity: GLOW, depthWrite: false };
    const nearer = { polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -1 };
    for (const mesh of meshes) add(mesh.geometry, mesh, { ...over, ...nearer });
  }
  if (!axis.some(Boolean)) return;
  const at = link.getWorldPosition(ball.position.clone());
  const far = at.distanceTo(page.camera.getWorldPosition(at.clone()));
  const along = at
    .clone()
    .set(...axis)
    .normalize();
  const round = new ball.geometry.constructor(0.5, 16, 8);
  /** @param {number} middle @param {number[]} size as parts of the distance */
  const part = (middle, size) => {
    const mesh = add(round, link, { depthTest: false, transparent: true });
    mesh.position.copy(along).multiplyScalar(middle * far);
    mesh.quaternion.setFromUnitVectors(at.clone().set(0, 0, 1), along);
    mesh.scale.set(...size.map((length) => length * far));
  };
  part(0, [THICK, THICK, LENGTH]);
  part(LENGTH / 2, [4 * THICK, 4 * THICK, 6 * THICK]);
}

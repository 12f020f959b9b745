// @ts-check
/* Controls of interactive markers: they are visible while the tool is Interact, and some of them
 * turn to the view, with their x along it and their z up.
 *
 * The server makes a node of viser for those of a marker that are turned and hidden together; a
 * file without a picture in it says how (displays/data/interactive_markers/control_nodes.py).
 */

/** How the axes of what faces the view are turned in the camera: x forward, y left, z up. */
const FACING = [-0.5, 0.5, 0.5, 0.5];

/** Let viser's node be dressed in place of the file that it was made from.
 * @param {any} object @param {any} eye the camera's matrixWorld */
export function nameGroup({ parent, userData }, eye) {
  const node = parent?.parent;
  if (!node || node.userData.drawAs) return;
  Object.assign(node.userData, userData, { drawAs: "controlGroup" });
  dressGroup(node, eye);
}

/** Hide controls, or turn them to the view.
 * @param {any} node @param {any} eye the camera's matrixWorld */
export function dressGroup(node, eye) {
  const { always, faces } = node.userData;
  if (!always && window.sambotViz?.controls === false) node.visible = false;
  if (!faces || !node.visible || !node.parent) return;
  const turn = node.quaternion;
  const above = node.parent.getWorldQuaternion(turn.clone()).invert();
  const forward = turn.clone().set(...FACING);
  turn.setFromRotationMatrix(eye).multiply(forward).premultiply(above);
  node.updateMatrixWorld(true);
}

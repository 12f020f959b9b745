"""The nodes of an interactive marker: its pose, and one for each group of controls."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from types import MappingProxyType

import viser

from sambot_viz.displays.data.interactive_markers.controls import (
    FIXED,
    VIEW_FACING,
    Group,
)
from sambot_viz.displays.data.markers.marker_nodes import MarkerNodes, Shown
from sambot_viz.displays.scene.frame_nodes import placed
from sambot_viz.displays.scene.glb_node import GlbNode, drawn_glb
from sambot_viz.displays.scene.posed_node import PosedNode
from sambot_viz.displays.scene.solid_nodes import AxesNode
from sambot_viz.geometry import IDENTITY, ORIGIN, Matrix, Vector3, Wxyz

AXES_DIAMETER = 0.05
"""Of the axes of a marker, by their length."""


class PoseNode(PosedNode[viser.FrameHandle]):
    """A node without its own picture."""

    def draw(self, wxyz: Wxyz, position: Vector3) -> None:
        """Make the node, or move it.

        Args:
            wxyz: rotation in the frame of the node above.
            position: there [m].
        """
        pose = placed(wxyz, position)
        if self._handle is None or self.is_gone:
            handle = self._scene.add_frame(
                self._name, show_axes=False, wxyz=pose[0], position=pose[1]
            )
            self.has_made(handle, pose)
        else:
            self.move(pose)


class GroupNode(GlbNode):
    """Controls that the page hides, and turns to the view, together."""

    def draw(self, group: Group, wxyz: Wxyz) -> None:
        """Make the node, or turn it.

        Args:
            group: what the page does with it.
            wxyz: rotation in its interactive marker.
        """
        said: dict[str, object] = {
            "faces": group.turning == VIEW_FACING,
            "always": group.is_always,
        }
        self.show((said,), lambda: drawn_glb("controls", {}, extras=said), wxyz, ORIGIN)


class InteractiveMarkerNodes:
    """The nodes of one interactive marker; what its controls show hangs below them.

    Args:
        scene: where to draw.
        name: short text that no other interactive marker has.
    """

    def __init__(self, scene: viser.SceneApi, name: str) -> None:
        self._scene = scene
        self._name = name
        self._path = ""
        self._root: PoseNode | None = None
        self._axes: AxesNode | None = None
        self._groups: dict[Group, GroupNode] = {}

    def path(self, group: Group) -> str:
        """Return the name of the node of a group."""
        return f"{self._path}/g{group.turning}{int(group.is_always)}"

    def draw(
        self,
        above: str,
        wxyz: Wxyz,
        position: Vector3,
        groups: Collection[Group],
        axes: float | None,
    ) -> bool:
        """Draw the nodes.

        Args:
            above: name of the node of the frame.
            wxyz: rotation of the marker in that frame.
            position: there [m].
            groups: that its controls have.
            axes: length of its axes [m]; None for no axes.

        Returns:
            Whether all that hangs below has to be made again.
        """
        path = f"{above}/{self._name}"
        root = self._root
        made = root is None or path != self._path or root.is_gone
        if made or root is None:
            self.remove()
            self._path = path
            root = self._root = PoseNode(self._scene, path)
            self._axes = AxesNode(self._scene, f"{path}/a")
        root.draw(wxyz, position)
        if self._axes is not None:
            if axes is None:
                self._axes.remove()
            else:
                self._axes.draw([IDENTITY], [ORIGIN], axes, abs(axes) * AXES_DIAMETER)
        for gone in self._groups.keys() - set(groups):
            self._groups.pop(gone).remove()
        w, x, y, z = wxyz
        for group in groups:
            node = self._groups.get(group)
            if node is None:
                node = self._groups[group] = GroupNode(self._scene, self.path(group))
            # Parallel to the frame, whatever the rotation of the marker.
            node.draw(group, (w, -x, -y, -z) if group.turning == FIXED else IDENTITY)
        return made

    def remove(self) -> None:
        """Take the nodes out of the scene, with all below them."""
        if self._root is not None:
            self._root.remove()
        self._root = self._axes = None
        self._groups.clear()


class ControlNodes(MarkerNodes):
    """Draws the markers of controls; the `frame` of each is its parent node.

    Attributes:
        poses: name of a parent node → its pose in the fixed frame, T_fixed_group, for
            nodes whose markers rays may hit.
    """

    poses: Mapping[str, Matrix] = MappingProxyType({})

    def _above(self, one: Shown) -> str | None:
        return one.frame

    def _pose_above(self, frame: str | None) -> Matrix | None:
        return None if frame is None else self.poses.get(frame)

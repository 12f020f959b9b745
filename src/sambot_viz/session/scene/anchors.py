"""Nodes that move with frames, for the nodes of a program to hang below.

The node of a frame is renamed when the frame gets another parent, as when the robot
begins to drive; a program's nodes below it would be gone then. An anchor keeps its
name, and comes back when a model that lost its frame has it again.
"""

from __future__ import annotations

import viser

from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.scene.frame_nodes import position_of
from sambot_viz.geometry import Vector3, Wxyz, wxyz_from_matrix
from sambot_viz.viser_private import is_removed, set_pose


def anchor_name(frame: str) -> str:
    """Return the name of the node that moves with a frame: "/@base_link"."""
    return f"/@{frame.replace('%', '%25').replace('/', '%2F')}"


class Anchors:
    """The anchors of a session; each step of a joint sends those that it moves.

    Args:
        context: the scene and the frames.
    """

    def __init__(self, context: DisplayContext) -> None:
        self._context = context
        self._nodes: dict[str, viser.FrameHandle | None] = {}
        self._sent: dict[str, tuple[Wxyz, Vector3]] = {}

    def add(self, frame: str) -> None:
        """Add the anchor of a frame, unless it is there."""
        self._nodes.setdefault(frame, None)
        self.place()

    def place(self) -> None:
        """Send where the anchors are now; those without a place are hidden."""
        for frame, node in self._nodes.items():
            if node is None or is_removed(node):
                # A program may have emptied the scene.
                node = self._context.scene.add_frame(
                    anchor_name(frame), show_axes=False
                )
                self._nodes[frame] = node
                self._sent.pop(frame, None)
            there = self._context.nodes.connected(frame)
            node.visible = there
            if there:
                self._place(frame, node)

    def _place(self, frame: str, node: viser.FrameHandle) -> None:
        T_fixed_frame = self._context.pose(frame)
        if T_fixed_frame is None:
            return
        pose = (wxyz_from_matrix(T_fixed_frame), position_of(T_fixed_frame))
        if self._sent.get(frame) != pose:
            self._sent[frame] = pose
            set_pose(node, *pose)

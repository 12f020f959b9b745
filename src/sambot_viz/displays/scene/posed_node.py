"""A node with a pose, of which only what has changed is sent."""

from __future__ import annotations

from typing import Generic, TypeVar

import viser

from sambot_viz.displays.scene.frame_nodes import Pose, any_gone, remove_all
from sambot_viz.geometry import IDENTITY, ORIGIN, Matrix
from sambot_viz.matrices import matrix_from_wxyz
from sambot_viz.viser_private import set_pose

Handle = TypeVar("Handle", bound=viser.SceneNodeHandle)


class PosedNode(Generic[Handle]):
    """A node of viser that is made when it is drawn first.

    Args:
        scene: where to draw.
        name: of the node; it is drawn in the frame of the node above.
    """

    def __init__(self, scene: viser.SceneApi, name: str) -> None:
        self._scene = scene
        self._name = name
        self._handle: Handle | None = None
        self._pose: Pose = (IDENTITY, ORIGIN)

    @property
    def is_gone(self) -> bool:
        """Whether the node was removed together with one above it."""
        return self._handle is not None and any_gone([self._handle])

    @property
    def is_drawn(self) -> bool:
        """Whether the node is in the scene."""
        return self._handle is not None and not self.is_gone

    def place(self, T_fixed_above: Matrix) -> Matrix:
        """Return T_fixed_node, (4, 4); only while it is drawn.

        Args:
            T_fixed_above: (4, 4), of the node above.
        """
        return T_fixed_above @ matrix_from_wxyz(*self._pose)

    def remove(self) -> None:
        """Take the node out of the scene."""
        if self._handle is not None:
            remove_all([self._handle])
            self._handle = None

    # For the nodes that derive from it

    def has_made(self, handle: Handle, pose: Pose) -> None:
        """Take the node of viser that was just made in a pose."""
        self._handle, self._pose = handle, pose

    def move(self, pose: Pose) -> None:
        """Send what has changed of the pose."""
        before, self._pose = self._pose, pose
        if self._handle is not None and pose != before:
            set_pose(
                self._handle,
                pose[0] if pose[0] != before[0] else None,
                pose[1] if pose[1] != before[1] else None,
            )

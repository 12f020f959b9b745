"""PoseArray: many poses, such as the particles of a localisation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from sambot_viz.displays.data.display_node import DisplayNode
from sambot_viz.displays.data.kept import Taken
from sambot_viz.displays.data.message_filter import MessageFilterDisplay
from sambot_viz.displays.data.message_numbers import Floats, poses_of
from sambot_viz.displays.data.poses.pose_shapes import (
    AXES,
    FLAT_ARROW,
    SOLID_ARROW,
    PoseShapes,
    arrow_properties,
    axes_properties,
    look_of,
    many_poses_properties,
)
from sambot_viz.displays.data.properties import metres
from sambot_viz.meanings import Meaning

_IF_SOLID = ("Shape", SOLID_ARROW)
Poses = tuple[Floats, Floats]
"""Rotations, (N, 4), and positions, (N, 3) [m]."""


class PoseArrayDisplay(MessageFilterDisplay[Poses]):
    """The poses of geometry_msgs/PoseArray; the newest message alone."""

    kind = "rviz_default_plugins/PoseArray"
    meanings = frozenset({Meaning.POSES})
    properties = (
        *many_poses_properties("pose"),
        metres(
            "Arrow Length", 0.3, "Length of the arrows.", shape=("Shape", FLAT_ARROW)
        ),
        *arrow_properties(_IF_SOLID, (0.23, 0.01, 0.07, 0.03), order=(3, 2, 1, 0)),
        *axes_properties(("Shape", AXES), 0.3, 0.01),
    )
    _shapes = DisplayNode(PoseShapes, "")

    def read(self, message: Any) -> Poses:
        """Return the rotations, (N, 4), and the positions, (N, 3) [m]."""
        return poses_of(message.poses)

    def draw_kept(self, kept: Sequence[Taken[Poses]]) -> None:
        """Draw the poses as they look now."""
        look = look_of(self.config)
        look = replace(look, flat=float(self.config.get("Arrow Length")))
        self._shapes.draw(look, *kept[-1].read, *kept[-1].pose)

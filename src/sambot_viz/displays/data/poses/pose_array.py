"""PoseArray: many poses, such as the particles of a localisation."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from sambot_viz.displays.data.message_numbers import Floats, poses_of
from sambot_viz.displays.data.newest_message import NewestMessageDisplay
from sambot_viz.displays.data.poses.pose_shapes import (
    AXES,
    FLAT_ARROW,
    SOLID_ARROW,
    PoseShapes,
    arrow_properties,
    axes_properties,
    color_property,
    look_of,
)
from sambot_viz.displays.data.properties import alpha_property, metres
from sambot_viz.displays.data.topic_display import topic_property
from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.picking.placed import Placed
from sambot_viz.geometry import Vector3, Wxyz
from sambot_viz.rviz import DisplayConfig, EnumProperty

_IF_ARROW = ("Shape", (FLAT_ARROW, SOLID_ARROW))
_IF_SOLID = ("Shape", SOLID_ARROW)
Poses = tuple[Floats, Floats]
"""Rotations, (N, 4), and positions, (N, 3) [m]."""


class PoseArrayDisplay(NewestMessageDisplay[Poses]):
    """The poses of geometry_msgs/PoseArray; the newest message alone."""

    kind = "rviz_default_plugins/PoseArray"
    help = "Many poses, such as the particles of a localisation."
    types = frozenset({"geometry_msgs/msg/PoseArray"})
    properties = (
        topic_property(),
        EnumProperty(
            "Shape",
            default=FLAT_ARROW,
            options=(FLAT_ARROW, SOLID_ARROW, AXES),
            help="How each pose is drawn.",
        ),
        color_property(shape=_IF_ARROW),
        alpha_property(hidden_unless=_IF_ARROW),
        metres(
            "Arrow Length", 0.3, "Length of the arrows.", shape=("Shape", FLAT_ARROW)
        ),
        *arrow_properties(_IF_SOLID, (0.23, 0.01, 0.07, 0.03), order=(3, 2, 1, 0)),
        *axes_properties(("Shape", AXES), 0.3, 0.01),
    )

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._shapes = PoseShapes(context.scene, f"/{key}")

    def read(self, message: Any) -> Poses:
        """Return the rotations, (N, 4), and the positions, (N, 3) [m]."""
        return poses_of(message.poses)

    def draw_read(self, read: Poses, wxyz: Wxyz, position: Vector3) -> None:
        """Draw the poses as they look now."""
        look = look_of(self.config)
        look = replace(look, flat=float(self.config.get("Arrow Length")))
        self._shapes.draw(look, *read, wxyz, position)

    def placed(self) -> Iterator[Placed]:
        """Yield the poses, which cannot be selected, as in RViz."""
        yield from self._shapes.placed(None)

    def remove(self) -> None:
        """Take the poses out of the scene."""
        self._shapes.remove()

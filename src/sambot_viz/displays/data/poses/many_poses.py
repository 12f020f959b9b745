"""What displays of many poses at once have in common."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeVar

from sambot_viz.displays.data.newest_message import NewestMessageDisplay
from sambot_viz.displays.data.poses.pose_shapes import (
    AXES,
    FLAT_ARROW,
    SOLID_ARROW,
    PoseShapes,
    color_property,
)
from sambot_viz.displays.data.properties import alpha_property
from sambot_viz.displays.data.topic_display import topic_property
from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.picking.placed import Placed
from sambot_viz.rviz import DisplayConfig, EnumProperty, Property

_IF_ARROW = ("Shape", (FLAT_ARROW, SOLID_ARROW))
T = TypeVar("T")


def many_poses_properties(each: str) -> tuple[Property, ...]:
    """Return the properties of the topic and of the shape of all poses.

    Args:
        each: what one of them is.
    """
    return (
        topic_property(),
        EnumProperty(
            "Shape",
            default=FLAT_ARROW,
            options=(FLAT_ARROW, SOLID_ARROW, AXES),
            help=f"How each {each} is drawn.",
        ),
        color_property(shape=_IF_ARROW),
        alpha_property(hidden_unless=_IF_ARROW),
    )


class ManyPosesDisplay(NewestMessageDisplay[T]):
    """Draws the poses of the newest message, all of which look alike."""

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._shapes = PoseShapes(context.scene, f"/{key}")

    def placed(self) -> Iterator[Placed]:
        """Yield the poses, which cannot be selected, as in RViz."""
        yield from self._shapes.placed(None)

    def remove(self) -> None:
        """Take the poses out of the scene."""
        self._shapes.remove()

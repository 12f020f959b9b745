"""Pose and PoseWithCovariance: the newest pose, as an arrow or as axes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from sambot_viz.displays.data.message_numbers import (
    Floats,
    covariance_of,
    point_of,
    wxyz_of,
)
from sambot_viz.displays.data.newest_message import NewestMessageDisplay
from sambot_viz.displays.data.poses.covariance import COVARIANCE, covariance_look
from sambot_viz.displays.data.poses.pose_shapes import (
    ARROW,
    AXES,
    PoseShapes,
    arrow_properties,
    axes_properties,
    color_property,
    look_of,
)
from sambot_viz.displays.data.properties import alpha_property
from sambot_viz.displays.data.selected_pose import SelectedPose
from sambot_viz.displays.data.topic_display import topic_property
from sambot_viz.displays.display import DisplayContext, numbers
from sambot_viz.displays.picking.placed import HERE, Placed
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.picking.selected import Fact, SelectedData
from sambot_viz.displays.scene.covariance import covariance_solids
from sambot_viz.displays.scene.solid_nodes import SolidsNode
from sambot_viz.geometry import Vector3, Wxyz
from sambot_viz.meanings import Meaning
from sambot_viz.rviz import DisplayConfig, EnumProperty

PoseRead = tuple[Wxyz, Vector3, Floats]
"""Rotation and position [m] of a pose in its frame, and its covariance, (36,)."""
NO_COVARIANCE = np.zeros(36)
_IF_ARROW, _IF_AXES = ("Shape", ARROW), ("Shape", AXES)
POSE_PROPERTIES = (
    topic_property(),
    EnumProperty(
        "Shape", default=ARROW, options=(ARROW, AXES), help="How the pose is drawn."
    ),
    color_property(shape=_IF_ARROW),
    alpha_property(hidden_unless=_IF_ARROW),
    *arrow_properties(_IF_ARROW),
    *axes_properties(_IF_AXES),
)


class PoseDisplay(NewestMessageDisplay[PoseRead]):
    """The pose of geometry_msgs/PoseStamped."""

    kind = "rviz_default_plugins/Pose"
    help = "A pose as an arrow or as axes."
    meanings = frozenset({Meaning.POSE})
    properties = POSE_PROPERTIES

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._shapes = PoseShapes(context.scene, f"/{key}")

    def read(self, message: Any) -> PoseRead:
        """Return the pose."""
        pose = message.pose
        return wxyz_of(pose.orientation), point_of(pose.position), NO_COVARIANCE

    def draw_read(self, read: PoseRead, wxyz: Wxyz, position: Vector3) -> None:
        """Draw the pose as it looks now."""
        turn, at, _ = read
        self._shapes.draw(look_of(self.config), [turn], [at], wxyz, position)

    @property
    def item(self) -> Selectable:
        """The pose as something that can be selected."""
        return Selectable("pose", self.config.name, self.key)

    def placed(self) -> Iterator[Placed]:
        """Yield the pose for rays."""
        yield from self._shapes.placed(self.item)

    def selected(self, item: Selectable) -> SelectedData | None:
        """Return the pose as its message has it."""
        taken = self.taken
        if item != self.item or taken is None:
            return None
        (turn, at, covariance), T = taken
        title, here = f"Pose {self.config.name}", T[:3, :3] @ np.array(at) + T[:3, 3]
        more = self.other_facts(covariance)
        return SelectedPose(title, self.frame, turn, at, here, more)

    def other_facts(self, covariance: Floats) -> Sequence[Fact]:
        """Return what else is said of a selected pose."""
        del covariance
        return ()

    def remove(self) -> None:
        """Take the pose out of the scene."""
        self._shapes.remove()


class PoseWithCovarianceDisplay(PoseDisplay):
    """The pose of geometry_msgs/PoseWithCovarianceStamped, and how uncertain it is."""

    kind = "rviz_default_plugins/PoseWithCovariance"
    help = "A pose with its uncertainty."
    meanings = frozenset({Meaning.POSE_WITH_COVARIANCE})
    properties = (*POSE_PROPERTIES, COVARIANCE)

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._solids = SolidsNode(context.scene, f"/{key}c")

    def read(self, message: Any) -> PoseRead:
        """Return the pose and its covariance."""
        turn, at, _ = super().read(message.pose)
        return turn, at, covariance_of(message.pose)

    def draw_read(self, read: PoseRead, wxyz: Wxyz, position: Vector3) -> None:
        """Draw the pose and its covariance as they look now."""
        super().draw_read(read, wxyz, position)
        turn, at, covariance = read
        look = covariance_look(self.config)
        solids = covariance_solids(covariance, turn, at, look)
        self._solids.draw(solids, wxyz=wxyz, position=position)

    def placed(self) -> Iterator[Placed]:
        """Yield the pose and its covariance for rays."""
        yield from super().placed()
        yield from self._solids.placed(HERE, self.item)

    def other_facts(self, covariance: Floats) -> Sequence[Fact]:
        """Return the variances of the position [m²] and of the orientation [rad²]."""
        variances = covariance[::7].tolist()
        return (
            ("Covariance Position", f"{numbers(variances[:3])} m²"),
            ("Covariance Orientation", f"{numbers(variances[3:])} rad²"),
        )

    def remove(self) -> None:
        """Take the pose out of the scene."""
        super().remove()
        self._solids.remove()

"""Pose and PoseWithCovariance: the newest pose, as an arrow or as axes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from sambot_viz.displays.data.display_node import DisplayNode
from sambot_viz.displays.data.kept import Taken
from sambot_viz.displays.data.message_filter import MessageFilterDisplay
from sambot_viz.displays.data.message_numbers import (
    Floats,
    covariance_of,
    point_of,
    wxyz_of,
)
from sambot_viz.displays.data.poses.covariance_properties import (
    COVARIANCE,
    covariance_look,
)
from sambot_viz.displays.data.poses.pose_shapes import (
    ARROW,
    AXES,
    PoseShapes,
    arrow_properties,
    arrow_sizes,
    axes_properties,
    color_property,
    look_of,
)
from sambot_viz.displays.data.properties import alpha_property
from sambot_viz.displays.data.selected_pose import SelectedPose
from sambot_viz.displays.data.topic_display import topic_property
from sambot_viz.displays.display import numbers
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.picking.selected import Fact, SelectedData
from sambot_viz.displays.scene.covariance import covariance_solids
from sambot_viz.displays.scene.solid_nodes import SolidsNode
from sambot_viz.displays.scene_size import SceneSize
from sambot_viz.geometry import Vector3, Wxyz
from sambot_viz.meanings import Meaning
from sambot_viz.rviz import EnumProperty
from sambot_viz.topics.decoding import frame_and_stamp

PoseRead = tuple[str, Wxyz, Vector3, Floats]
"""The frame of a pose, its rotation and position [m] there, its covariance, (36,)."""
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


class PoseDisplay(MessageFilterDisplay[PoseRead]):
    """The pose of geometry_msgs/PoseStamped."""

    kind = "rviz_default_plugins/Pose"
    meanings = frozenset({Meaning.POSE})
    properties = POSE_PROPERTIES
    _shapes = DisplayNode(PoseShapes, "")

    @classmethod
    def size_values(cls, size: SceneSize) -> Mapping[str, float]:
        """Return an arrow as long as the robot."""
        return arrow_sizes(size)

    def read(self, message: Any) -> PoseRead:
        """Return the pose."""
        return (*_frame_and_pose(message, message.pose), NO_COVARIANCE)

    def draw_kept(self, kept: Sequence[Taken[PoseRead]]) -> None:
        """Draw the pose as it looks now."""
        _, turn, at, _ = kept[-1].read
        self._shapes.draw(look_of(self.config), [turn], [at], *kept[-1].pose)

    @property
    def item(self) -> Selectable:
        """The pose as something that can be selected."""
        return Selectable("pose", self.config.name, self.key)

    def selected(self, item: Selectable) -> SelectedData | None:
        """Return the pose as its message has it."""
        if item != self.item or not self.kept:
            return None
        (frame, turn, at, covariance), T = (
            self.kept[-1].read,
            self.kept[-1].T_fixed_frame,
        )
        title, here = f"Pose {self.config.name}", T[:3, :3] @ np.array(at) + T[:3, 3]
        more = self.other_facts(covariance)
        return SelectedPose(title, frame, turn, at, here, more)

    def other_facts(self, covariance: Floats) -> Sequence[Fact]:
        """Return further details of a selected pose."""
        del covariance
        return ()


class PoseWithCovarianceDisplay(PoseDisplay):
    """The pose of geometry_msgs/PoseWithCovarianceStamped, and how uncertain it is."""

    kind = "rviz_default_plugins/PoseWithCovariance"
    meanings = frozenset({Meaning.POSE_WITH_COVARIANCE})
    properties = (*POSE_PROPERTIES, COVARIANCE)
    _solids = DisplayNode(SolidsNode, "c")

    def read(self, message: Any) -> PoseRead:
        """Return the pose and its covariance."""
        pose = message.pose
        return (*_frame_and_pose(message, pose.pose), covariance_of(pose))

    def draw_kept(self, kept: Sequence[Taken[PoseRead]]) -> None:
        """Draw the pose and its covariance as they look now."""
        super().draw_kept(kept)
        (_, turn, at, covariance), (wxyz, position) = kept[-1].read, kept[-1].pose
        look = covariance_look(self.config)
        solids = covariance_solids(covariance, turn, at, look)
        self._solids.draw(solids, wxyz=wxyz, position=position)

    def other_facts(self, covariance: Floats) -> Sequence[Fact]:
        """Return the variances of the position [m²] and of the orientation [rad²]."""
        variances = covariance[::7].tolist()
        return (
            ("Covariance Position", f"{numbers(variances[:3])} m²"),
            ("Covariance Orientation", f"{numbers(variances[3:])} rad²"),
        )


def _frame_and_pose(message: Any, pose: Any) -> tuple[str, Wxyz, Vector3]:
    """Return the frame of a message, and rotation and position [m] of a pose there."""
    frame, _ = frame_and_stamp(message)
    return frame, wxyz_of(pose.orientation), point_of(pose.position)

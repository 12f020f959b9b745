"""Pose and PoseWithCovariance: the newest pose, as an arrow or as axes."""

from __future__ import annotations

from typing import Any

import numpy as np

from sambot_viz.displays.data.message_filter import MessageFilterDisplay
from sambot_viz.displays.data.message_numbers import point_of, wxyz_of
from sambot_viz.displays.data.poses.covariance import COVARIANCE, covariance_look
from sambot_viz.displays.data.poses.pose_shapes import (
    ARROW,
    AXES,
    PoseShapes,
    alpha_property,
    arrow_properties,
    axes_properties,
    color_property,
    look_of,
)
from sambot_viz.displays.data.topic_display import topic_property
from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.scene.covariance import covariance_solids
from sambot_viz.displays.scene.nodes import position_of
from sambot_viz.displays.scene.solid_nodes import SolidsNode
from sambot_viz.frames import Transform
from sambot_viz.geometry import Vector3, Wxyz, wxyz_from_matrix
from sambot_viz.rviz import DisplayConfig, EnumProperty
from sambot_viz.sources.message import Recorded

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


class PoseDisplay(MessageFilterDisplay):
    """The pose of geometry_msgs/PoseStamped."""

    kind = "rviz_default_plugins/Pose"
    help = "A pose as an arrow or as axes."
    types = frozenset({"geometry_msgs/msg/PoseStamped"})
    properties = POSE_PROPERTIES

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._shapes = PoseShapes(context.scene, f"/{key}")
        self._pose: tuple[Wxyz, Vector3] | None = None
        self._frame = Transform.identity()

    def process(self, message: Any, T_fixed_frame: Transform, came: Recorded) -> None:
        """Draw a pose in the place of the one before."""
        self._pose = wxyz_of(message.pose.orientation), point_of(message.pose.position)
        self._frame = T_fixed_frame
        self._show()

    def drop(self) -> None:
        """Take the pose out of the scene."""
        self._pose = None
        self._shapes.remove()

    def redraw(self) -> None:
        """Draw the pose as it looks now."""
        super().redraw()
        self._show()

    def _show(self) -> None:
        if self._pose is not None:
            wxyz, position = self._pose
            T = self._frame.matrix
            place = wxyz_from_matrix(T), position_of(T)
            self._shapes.draw(look_of(self.config), [wxyz], [position], *place)


class PoseWithCovarianceDisplay(PoseDisplay):
    """The pose of geometry_msgs/PoseWithCovarianceStamped, and how uncertain it is."""

    kind = "rviz_default_plugins/PoseWithCovariance"
    help = "A pose with its uncertainty."
    types = frozenset({"geometry_msgs/msg/PoseWithCovarianceStamped"})
    properties = (*POSE_PROPERTIES, COVARIANCE)

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._solids = SolidsNode(context.scene, f"/{key}c")
        self._covariance = np.zeros(36)

    def process(self, message: Any, T_fixed_frame: Transform, came: Recorded) -> None:
        """Draw a pose in the place of the one before."""
        self._covariance = np.array(message.pose.covariance, np.float64)
        super().process(message.pose, T_fixed_frame, came)

    def drop(self) -> None:
        """Take the pose out of the scene."""
        super().drop()
        self._solids.remove()

    def _show(self) -> None:
        super()._show()
        if self._pose is not None:
            T = self._frame.matrix
            look = covariance_look(self.config)
            solids = covariance_solids(self._covariance, *self._pose, look)
            wxyz, position = wxyz_from_matrix(T), position_of(T)
            self._solids.draw(solids, wxyz=wxyz, position=position)

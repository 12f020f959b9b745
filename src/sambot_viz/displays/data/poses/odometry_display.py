"""Odometry: where the robot was, as it says itself."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz import limits
from sambot_viz.displays.data.display_node import DisplayNode
from sambot_viz.displays.data.kept import Taken
from sambot_viz.displays.data.message_filter import MessageFilterDisplay
from sambot_viz.displays.data.message_numbers import (
    covariance_of,
    point_of,
    require_finite,
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
from sambot_viz.displays.data.refused_messages import MessageRefused
from sambot_viz.displays.data.topic_display import TOPIC, topic_property
from sambot_viz.displays.scene.covariance import CovarianceLook, covariance_solids
from sambot_viz.displays.scene.frame_nodes import position_of
from sambot_viz.displays.scene.solid_nodes import Solid, SolidsNode
from sambot_viz.displays.scene_size import SceneSize
from sambot_viz.frames import Transform
from sambot_viz.geometry import (
    Matrix,
    Vector3,
    Wxyz,
    wxyz_from_matrix,
    wxyz_product,
    wxyz_rotated,
)
from sambot_viz.meanings import Meaning
from sambot_viz.rviz import EnumProperty, FloatProperty, IntProperty
from sambot_viz.sources.message import Recorded

_IF_ARROW, _IF_AXES = ("Shape", ARROW), ("Shape", AXES)
_UNNORMALIZED = 0.01


class _PastPose:
    """A pose that stays where it was.

    Attributes:
        wxyz: its rotation in the frame of its message.
        position: there [m].
        fixed: its rotation and its position in the fixed frame.
    """

    def __init__(
        self,
        wxyz: Wxyz,
        position: Vector3,
        T_fixed_frame: Matrix,
        covariance: npt.NDArray[np.float64],
    ) -> None:
        self.wxyz, self.position = wxyz, position
        self._frame = wxyz_from_matrix(T_fixed_frame)
        self._at = position_of(T_fixed_frame)
        self.fixed = _moved(self._frame, self._at, wxyz, position)
        self._covariance = covariance
        self._look: CovarianceLook | None = None
        self._solids: list[Solid] = []

    def solids(self, look: CovarianceLook) -> list[Solid]:
        """Return the shapes of its covariance in the fixed frame."""
        if look != self._look:
            found = covariance_solids(self._covariance, self.wxyz, self.position, look)
            self._solids = [_placed(solid, self._frame, self._at) for solid in found]
            self._look = look
        return self._solids


class OdometryDisplay(MessageFilterDisplay[_PastPose]):
    """The poses of nav_msgs/Odometry that are apart from each other."""

    kind = "rviz_default_plugins/Odometry"
    meanings = frozenset({Meaning.ODOMETRY})
    properties = (
        topic_property(),
        FloatProperty(
            "Position Tolerance",
            default=0.1,
            minimum=0.0,
            unit="m",
            help="A pose that is nearer to the last one is left out, if it is not "
            "turned either.",
        ),
        FloatProperty(
            "Angle Tolerance",
            default=0.1,
            minimum=0.0,
            unit="rad",
            help="A pose that is turned by less is left out, if it is near, too.",
        ),
        IntProperty(
            "Keep",
            default=100,
            minimum=0,
            help="Number of poses to show; 0 shows all, up to "
            f"{limits.ODOMETRY_POSES.value:,}.",
        ),
        EnumProperty(
            "Shape",
            default=ARROW,
            options=(ARROW, AXES),
            help="How poses are drawn.",
            children=(
                color_property(shape=_IF_ARROW),
                alpha_property(hidden_unless=_IF_ARROW),
                *arrow_properties(_IF_ARROW),
                *axes_properties(_IF_AXES),
            ),
        ),
        COVARIANCE,
    )
    _shapes = DisplayNode(PoseShapes, "")
    _solids = DisplayNode(SolidsNode, "c")

    @classmethod
    def size_values(cls, size: SceneSize) -> Mapping[str, float]:
        """Return arrows as long as the robot."""
        return arrow_sizes(size, "Shape/")

    @property
    def most(self) -> int:
        """Number of poses shown."""
        most = limits.ODOMETRY_POSES.value
        return min(int(self.config.get("Keep")) or most, most)

    @property
    def needs_last_only(self) -> bool:
        """Return False: earlier poses stay."""
        return False

    def process(self, message: Any, T_fixed_frame: Transform, came: Recorded) -> None:
        """Keep a pose if it is apart from the last one."""
        pose = message.pose.pose
        q = pose.orientation
        x, y, z, w = float(q.x), float(q.y), float(q.z), float(q.w)
        position = point_of(pose.position)
        require_finite((x, y, z, w))
        if abs(x * x + y * y + z * z + w * w - 1.0) >= _UNNORMALIZED:
            raise MessageRefused(
                "Message contained unnormalized quaternion (squares of values don't "
                "add to 1)",
                TOPIC,
            )
        wxyz = (w, x, y, z)
        if self.kept and not self._is_apart(wxyz, position):
            return
        T, covariance = T_fixed_frame.matrix, covariance_of(message.pose)
        self.kept.append(Taken(_PastPose(wxyz, position, T, covariance), T))

    def _is_apart(self, wxyz: Wxyz, position: Vector3) -> bool:
        last = self.kept[-1].read
        if math.dist(position, last.position) >= self._tolerance("Position"):
            return True
        w, x, y, z = last.wxyz
        turned, *axis = wxyz_product(wxyz, (w, -x, -y, -z))
        angle = 2 * math.atan2(math.hypot(*axis), turned)
        return angle >= self._tolerance("Angle")

    def _tolerance(self, of: str) -> float:
        return float(self.config.get(f"{of} Tolerance"))

    def draw_kept(self, kept: Sequence[Taken[_PastPose]]) -> None:
        """Draw the poses as they look now."""
        turns, places = zip(*(one.read.fixed for one in kept), strict=True)
        self._shapes.draw(look_of(self.config, "Shape/"), turns, places)
        look = covariance_look(self.config)
        self._solids.draw([solid for one in kept for solid in one.read.solids(look)])


def _moved(
    frame: Wxyz, at: Vector3, wxyz: Wxyz, position: Vector3
) -> tuple[Wxyz, Vector3]:
    """Return a pose of a frame where that frame was."""
    dx, dy, dz = wxyz_rotated(frame, position)
    return wxyz_product(frame, wxyz), (at[0] + dx, at[1] + dy, at[2] + dz)


def _placed(solid: Solid, frame: Wxyz, at: Vector3) -> Solid:
    """Return a solid of a frame where that frame was."""
    wxyz, position = _moved(frame, at, solid.wxyz, solid.position)
    return Solid(solid.kind, wxyz, position, solid.scale, solid.color, solid.alpha)

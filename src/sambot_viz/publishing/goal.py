"""A goal for a robot, as RViz's tool 2D Goal Pose sends it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from sambot_viz.errors import PublishError

POSE_STAMPED = "geometry_msgs/msg/PoseStamped"


@dataclass(frozen=True, slots=True)
class Goal:
    """Where a robot is to go.

    Attributes:
        frame: in which the place is given.
        x: the place on the ground [m].
        y: the same.
        yaw: the heading about the vertical axis [rad].

    Raises:
        PublishError: a number that is not finite, or no frame.
    """

    frame: str
    x: float
    y: float
    yaw: float

    def __post_init__(self) -> None:
        if not all(map(math.isfinite, (self.x, self.y, self.yaw))):
            numbers = f"({self.x}, {self.y}, {self.yaw})"
            raise PublishError(f"a goal needs finite numbers, not {numbers}")
        if not self.frame:
            raise PublishError("a goal needs a frame, such as map")

    @property
    def orientation_zw(self) -> tuple[float, float]:
        """Components z and w of the unit quaternion of the heading; x and y are 0."""
        # RViz's own formula, so that the bytes are the same.
        half = math.cos(self.yaw / 2.0)
        z = math.sin(self.yaw) / (2.0 * half) if half else math.sin(self.yaw / 2.0)
        return z, half

    def fields(self, stamp: object) -> dict[str, Any]:
        """Return the fields of the message.

        Args:
            stamp: its time, as the transport wants it (see `written.stamp_for`).
        """
        z, w = self.orientation_zw
        return {
            "header": {"stamp": stamp, "frame_id": self.frame},
            "pose": {
                "position": {"x": float(self.x), "y": float(self.y), "z": 0.0},
                "orientation": {"x": 0.0, "y": 0.0, "z": z, "w": w},
            },
        }

    @property
    def words(self) -> str:
        """The line that RViz logs when it sends one."""
        z, w = self.orientation_zw
        return (
            f"Setting goal pose: Frame:{self.frame}, Position({self.x:g}, {self.y:g}, "
            f"0), Orientation(0, 0, {z:g}, {w:g}) = Angle: {self.yaw:g}"
        )

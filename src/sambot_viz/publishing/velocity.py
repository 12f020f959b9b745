"""Velocities of a robot with wheels, as teleop_twist_keyboard and Nav2 send them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

TWIST, TWIST_STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"
"""Which of them a robot takes, only its own nodes know."""
VELOCITY_TYPES = (TWIST, TWIST_STAMPED)


@dataclass(frozen=True, slots=True)
class Velocity:
    """A velocity; its message has no frame, as that of other teleoperation.

    Attributes:
        type_name: of the message, one of `VELOCITY_TYPES`.
        linear: forwards [m/s].
        angular: to the left [rad/s].
    """

    type_name: str
    linear: float = 0.0
    angular: float = 0.0

    @property
    def numbers(self) -> tuple[float, ...]:
        """The linear [m/s] and the angular velocity [rad/s]."""
        return self.linear, self.angular

    def fields(self, stamp: object) -> dict[str, Any]:
        """Return the fields of the message.

        Args:
            stamp: its time, as the transport wants it (see `written.written`).
        """
        zero = {"x": 0.0, "y": 0.0, "z": 0.0}
        twist = {
            "linear": {**zero, "x": self.linear},
            "angular": {**zero, "z": self.angular},
        }
        if self.type_name == TWIST:
            return twist
        return {"header": {"stamp": stamp, "frame_id": ""}, "twist": twist}

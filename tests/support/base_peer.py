"""A robot on the network whose base takes velocities."""

from __future__ import annotations

import struct
from typing import Any

from navigator_peer import NavigatorPeer

CMD_VEL = "/cmd_vel"
TWIST = "geometry_msgs/msg/Twist"


class BasePeer(NavigatorPeer):
    """Takes velocities, and goals as a navigator does.

    Args:
        type_name: of its velocities; "" where it does not say it.
        options: as for `NavigatorPeer`.
    """

    def __init__(self, type_name: str = TWIST, **options: Any) -> None:
        self.has_type = bool(type_name)
        super().__init__(**options)
        if type_name:
            self.offer(CMD_VEL, type_name)
        self.listen_as(CMD_VEL, "/base")

    def speeds(self) -> list[tuple[float, float]]:
        """The velocities that have come: linear [m/s], angular [rad/s]."""
        found = [bytes(one.content)[-48:] for one in self.came()]
        numbers = (struct.unpack("<6d", one) for one in found)
        return [(x, w) for x, _, _, _, _, w in numbers]

    def rests(self) -> bool:
        """Whether the last that came are three zero velocities."""
        return self.speeds()[-3:] == [(0.0, 0.0)] * 3

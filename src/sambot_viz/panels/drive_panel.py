"""The Drive panel: speeds, buttons to hold, keys, and the pose in odom.

Keys are those of a number pad, because viser's camera has WASD, QE and the arrows:
8 and 2 change the linear speed, 4 and 6 the angular one, 5 stops.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import partial
from typing import Any

from sambot_viz.drive.differential import WheelPair
from sambot_viz.errors import UsageError
from sambot_viz.panels.command import NUMBER, TEXT, command
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Answer, Data, Kind, Row
from sambot_viz.session.clients.follow_view import FollowView
from sambot_viz.session.robot.robot_drive import KEEP, ODOM, Drive
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.signals import Signal

MOST_LINEAR, MOST_ANGULAR = 1.0, 2.0
"""Limits of the speeds [m/s] and [rad/s]."""
KEYS = {"8": (0.1, 0.0), "2": (-0.1, 0.0), "4": (0.0, 0.25), "6": (0.0, -0.25)}
"""Added by one press of a key [m/s] and [rad/s]."""
STOP_KEY = "5"
_POSE, _WHEELS, _ALONE = "drive/pose", "drive/wheels", "drive/alone"


class DrivePanel(Panel):
    """Drives a robot with two wheels; without them the panel is empty.

    Args:
        follow_view: shows the motion, and puts the view back at Back to start.
    """

    name = "drive"
    period = 0.1

    def __init__(
        self, drive: Drive, robot: RobotState, follow_view: FollowView
    ) -> None:
        self.remade_by = (robot.changed,)
        self._drive = drive
        self._robot = robot
        self._follow_view = follow_view

    @property
    def moved_by(self) -> Sequence[Signal[Any]]:
        """The speeds and the pose."""
        drive = self._drive
        return (drive.velocity, drive.left_alone, drive.pose_changed)

    def rows(self) -> Sequence[Row]:
        """Return the speeds, where the robot is, and its wheels."""
        wheels, robot = self._drive.wheels, self._robot.model
        if wheels is None or robot is None:
            return []
        return [
            *self._speeds(),
            *self._pose(robot.root),
            *_measures(wheels),
        ]

    def data(self) -> Sequence[Data]:
        """Return whether the robot was stopped because its driving page was gone."""
        wheels = self._drive.wheels
        return [] if wheels is None else [Data(_ALONE, self._drive.left_alone.value)]

    def values(self) -> dict[str, Any]:
        """Return the speeds, and the pose in odom."""
        drive = self._drive
        if drive.wheels is None:
            return {}
        pose = drive.pose
        return {
            "drive/linear": drive.v,
            "drive/angular": drive.w,
            # A tenth of a millimetre; smaller changes are invisible and not sent.
            "drive/x": round(pose.x, 4) + 0.0,
            "drive/y": round(pose.y, 4) + 0.0,
            "drive/yaw": round(math.remainder(pose.yaw, math.tau), 4) + 0.0,
            _ALONE: drive.left_alone.value,
        }

    def _speeds(self) -> Iterator[Row]:
        value = self.values()

        def speed(row_id: str, name: str, unit: str, most: float, help: str) -> Row:
            return Row(
                row_id,
                "",
                "slider",
                name,
                value=value[row_id],
                unit=unit,
                least=-most,
                most=most,
                step=0.01,
                help=help,
                set=partial(self._set_speed, row_id),
            )

        yield speed(
            "drive/linear", "Linear speed", "m/s", MOST_LINEAR, "Forwards, along x."
        )
        yield speed(
            "drive/angular", "Angular speed", "rad/s", MOST_ANGULAR, "To the left."
        )

    def _pose(self, root: str) -> Iterator[Row]:
        value = self.values()
        yield Row(_POSE, "", "group", f"{root} in {ODOM}", expanded=True)
        for part, unit in (("x", "m"), ("y", "m"), ("yaw", "rad")):
            row_id = f"drive/{part}"
            yield _fact(row_id, _POSE, part, value[row_id], unit)

    # Driving by hand

    def _set_speed(self, row_id: str, value: float) -> Answer | None:
        linear = row_id == "drive/linear"
        v, w = (value, self._drive.w) if linear else (self._drive.v, value)
        return self._go(v, w)

    def offers(self, command_id: str) -> bool:
        """Return whether there is a robot with two wheels."""
        return self._drive.wheels is not None and self._robot.model is not None

    @command("drive/hold", NUMBER, NUMBER)
    def _hold(self, v: float, w: float) -> Answer | None:
        """Drive a little; a button that is held says so again and again."""
        return self._go(v, w)

    @command("drive/press", TEXT)
    def _press(self, key: str) -> Answer | None:
        if key == STOP_KEY:
            self._drive.stop()
            return None
        if key not in KEYS:
            raise UsageError(f"no key '{key}' drives the robot")
        more_v, more_w = KEYS[key]
        # Sums of tenths, without the last digits of binary numbers.
        v, w = round(self._drive.v + more_v, 6), round(self._drive.w + more_w, 6)
        return self._go(v, w)

    @command("drive/keep")
    def _keep(self) -> None:
        """Drive on: a page that drives says again and again that it is there."""
        self._drive.go_on(KEEP)

    @command("drive/find", client_local=True)
    def _find(self) -> None:
        self._follow_view.find()

    @command("drive/stop")
    def _stop(self) -> None:
        self._drive.stop()

    @command("drive/reset")
    def _reset(self) -> Answer | None:
        put_back = self._follow_view.back_to_start()
        return Answer(f"Fixed Frame is {put_back} again") if put_back else None

    def _go(self, v: float, w: float) -> Answer | None:
        """Drive; from rest, see to it that the motion can be seen."""
        v, w = _within(MOST_LINEAR, v), _within(MOST_ANGULAR, w)
        starts = not self._drive.moving and (v != 0 or w != 0)
        shown = starts and self._follow_view.show_motion()
        self._drive.set_velocity(v, w, KEEP)
        if not shown:
            return None
        return Answer(f"Fixed Frame is now {ODOM}. Undo puts it back.")


def _measures(wheels: WheelPair) -> Iterator[Row]:
    yield Row(_WHEELS, "", "group", "Wheels")
    yield _fact("drive/left", _WHEELS, "Left", wheels.left)
    yield _fact("drive/right", _WHEELS, "Right", wheels.right)
    yield _fact("drive/radius", _WHEELS, "Radius", wheels.radius, "m")
    yield _fact("drive/apart", _WHEELS, "Apart", wheels.separation, "m")


def _fact(row_id: str, parent: str, name: str, value: Any, unit: str = "") -> Row:
    kind: Kind = "float" if unit else "readonly"
    return Row(row_id, parent, kind, name, value=value, unit=unit)


def _within(most: float, value: float) -> float:
    return min(most, max(-most, value))

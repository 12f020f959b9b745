"""Draws where a robot was driven."""

from __future__ import annotations

from sambot_viz.displays.scene.lines import PathLine
from sambot_viz.session.robot.drive import ODOM, Drive
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.signals import Change, Listening, connect
from sambot_viz.session.worker import Throttle, Worker

PERIOD = 0.2
"""The trail is drawn at most this often [s]."""


class DriveTrail:
    """Draws a line on the floor of odom.

    Args:
        drive: knows where the robot was.
        robot: another one may have no wheels.
        scene: where to draw.
        change: sends the line.
        worker: draws.
    """

    def __init__(
        self,
        drive: Drive,
        robot: RobotState,
        scene: Scene,
        change: Change,
        worker: Worker,
    ) -> None:
        self._drive = drive
        self._context = scene.context
        self._change = change
        self._line = PathLine(scene.context.scene)
        self._drawing = Throttle(worker, PERIOD, self._draw)
        self._others = (scene.frames, robot.changed)
        self._driven = Listening(self._drawing.request)
        connect([drive.pose_changed], self._moved)

    def close(self) -> None:
        """Draw nothing any more."""
        self._drawing.close()

    def _moved(self) -> None:
        # A robot that never drove has no trail: until then nothing else matters.
        self._driven.to(*self._others)
        self._drawing.request()

    def _draw(self) -> None:
        with self._change():
            above = self._context.nodes.path(ODOM)
            self._line.draw(above, self._drive.trail or ((0.0, 0.0),))

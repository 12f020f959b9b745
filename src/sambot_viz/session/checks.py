"""Problems of the robot and the config that a session shows.

The rules run after the robot is drawn, so that the picture never waits for them. What
they find joins what was found while loading, in the Problems panel.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz.errors import Problem
from sambot_viz.meshes.asset import Asset
from sambot_viz.meshes.mesh import Mesh
from sambot_viz.session.signals import connect

if TYPE_CHECKING:
    from sambot_viz.robot.model import Robot
    from sambot_viz.session import Session


class CheckResults:
    """Keeps the problems of one session up to date.

    Args:
        session: whose robot and config are checked.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self._of_robot: tuple[Problem, ...] = ()
        self._checked: tuple[object, ...] | None = None
        signals = session.signals
        connect([signals.config, signals.frames, signals.status], self._follow)

    def give(self) -> None:
        """Check what is shown; the robot only when there is more to know of it."""
        session = self._session
        with session.lock:
            robot, joints = session.robot, session.joints
            if robot is None or joints is None:
                return
            before, self._checked = self._checked, self._state()
            of_joints, of_config = joints.problems, self._of_config(robot)
        if before != self._checked:
            # The import is late so that the first page does not wait for the rules.
            from sambot_viz.checks import check_robot

            self._of_robot = tuple(check_robot(robot, mesh=self._mesh))
        problems = (*self._of_robot, *of_joints, *of_config)
        with session.lock:
            if session.robot is robot and session.problems.of_model != problems:
                with session.change():
                    session.problems.set_model(problems)

    def _mesh(self, path: Path) -> Mesh | None:
        """A mesh that has been read for the picture; the rules read none themselves.

        Meshes that cannot be drawn are reported by the display that draws them.
        """
        found = self._session.context.assets.known(Asset("mesh", path))
        return found if isinstance(found, Mesh) else None

    def _state(self) -> tuple[object, ...]:
        """The robot, with what is known of its meshes."""
        session = self._session
        return (id(session.robot), session.context.assets.read_count)

    def _follow(self) -> None:
        """Check again after a change that may fix, or bring, a problem."""
        if self._checked is not None and self._checked[0] == id(self._session.robot):
            self.give()

    def _of_config(self, robot: Robot) -> list[Problem]:
        from sambot_viz.checks.config_against_robot import check_config

        session = self._session
        frame_exists = session.context.fixed_frame in session.tree
        return [
            problem
            for problem in check_config(robot, session.config)
            if not (frame_exists and problem.code == "setup-fixed-frame")
        ]

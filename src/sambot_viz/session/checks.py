"""What the checks say of the robot and the config that a session shows.

The rules look once the robot is drawn, so that the picture never waits for them; what
they find joins what was met while loading, in the Problems panel.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from sambot_viz import bundled
from sambot_viz.errors import Problem

if TYPE_CHECKING:
    from sambot_viz.robot.model import Robot
    from sambot_viz.session import Event, Session


class CheckResults:
    """Follows one session; `give` lets the checks look.

    Args:
        session: whose robot and config are looked at.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self._robot: Robot | None = None
        self._of_robot: tuple[Problem, ...] = ()
        self._looked_at: tuple[object, ...] | None = None
        session.listeners.append(self._hear)

    def give(self) -> None:
        """Check what is shown, unless that has been done already."""
        session = self._session
        with session.lock:
            robot, joints = session.robot, session.joints
            if robot is None or joints is None:
                return
            self._looked_at = self._state()
            of_joints, of_config = joints.problems, self._of_config(robot)
        if robot is not self._robot:
            # Only now: the first page must not wait for the rules to be imported.
            from sambot_viz.checks import check_robot

            self._of_robot, self._robot = tuple(check_robot(robot)), robot
        problems = (*self._of_robot, *of_joints, *of_config)
        with session.lock:
            if session.robot is robot and session.problems != problems:
                with session.change():
                    session.set_problems(problems)

    def _state(self) -> tuple[object, ...]:
        """What the findings of the config depend on."""
        session = self._session
        fixed = session.context.fixed_frame
        config = session.config
        return (id(session.robot), id(config), fixed, fixed in session.tree)

    def _hear(self, event: Event) -> None:
        """A fixed frame that was chosen, or published, may mend what was found."""
        if event in ("config", "frames") and self._looked_at is not None:
            if self._looked_at[0] == id(self._session.robot):
                if self._looked_at != self._state():
                    self.give()

    def _of_config(self, robot: Robot) -> list[Problem]:
        from sambot_viz.checks.config_against_robot import check_setup

        session = self._session
        if session.config.file == str(bundled.config_path()):
            # Nobody can mend the config that comes with the program.
            return []
        frame_is_there = session.context.fixed_frame in session.tree
        return [
            problem
            for problem in check_setup(robot, session.config)
            if not (frame_is_there and problem.code == "setup-fixed-frame")
        ]

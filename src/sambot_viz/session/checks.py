"""Problems of the robot and the config that a session shows.

The rules run after the robot is drawn, so that the picture never waits for them. What
they find joins what was found while loading, in the Problems panel.
"""

from __future__ import annotations

from pathlib import Path

from sambot_viz.errors import Problem
from sambot_viz.meshes.asset import Asset
from sambot_viz.meshes.mesh import Mesh
from sambot_viz.robot.model import Robot
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.problems import Problems
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.signals import Change, connect


class Checks:
    """Keeps the problems that the rules find up to date.

    Args:
        robot: is checked.
        document: is checked against it.
        scene: has read its meshes.
        problems: takes what was found.
        change: sends it.
    """

    def __init__(
        self,
        robot: RobotState,
        document: ShownDocument,
        scene: Scene,
        problems: Problems,
        change: Change,
    ) -> None:
        self._robot = robot
        self._document = document
        self._context = scene.context
        self._problems = problems
        self._change = change
        self._of_robot: tuple[Problem, ...] = ()
        self._checked: tuple[object, ...] | None = None
        facts = [document.replaced, document.options, document.displays]
        connect([*facts, scene.frames, scene.statuses], self._follow)

    def run(self) -> None:
        """Check what is shown; the robot only when there is more to know of it."""
        with self._change.lock:
            robot, joints = self._robot.model, self._robot.joints
            if robot is None or joints is None:
                return
            before, self._checked = self._checked, self._state()
            of_joints, of_config = joints.problems, self._of_config(robot)
        if before != self._checked:
            # The import is late so that the first page does not wait for the rules.
            from sambot_viz.checks import check_robot

            self._of_robot = tuple(check_robot(robot, mesh=self._mesh))
        found = (*self._of_robot, *of_joints, *of_config)
        with self._change.lock:
            if self._robot.model is robot and self._problems.of_model != found:
                self._problems.set_model(found)

    def _mesh(self, path: Path) -> Mesh | None:
        """A mesh that has been read for the picture; the rules read none themselves.

        Meshes that cannot be drawn are reported by the display that draws them.
        """
        found = self._context.assets.known(Asset("mesh", path))
        return found if isinstance(found, Mesh) else None

    def _state(self) -> tuple[object, ...]:
        """The robot, with what is known of its meshes."""
        return (id(self._robot.model), self._context.assets.read_count)

    def _follow(self) -> None:
        """Check again after a change that may fix, or bring, a problem."""
        if self._checked is not None and self._checked[0] == id(self._robot.model):
            self.run()

    def _of_config(self, robot: Robot) -> list[Problem]:
        from sambot_viz.checks.config_against_robot import check_config

        frame_exists = self._context.fixed_frame in self._context.tree
        return [
            problem
            for problem in check_config(robot, self._document.config)
            if not (frame_exists and problem.code == "setup-fixed-frame")
        ]

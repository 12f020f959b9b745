"""The named poses of the Joints panel."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from sambot_viz.errors import UsageError
from sambot_viz.joints.presets import Presets
from sambot_viz.panels.command import TEXT, command
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.row import Answer, Data
from sambot_viz.session.limits import MOST_POSES, require_room
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.undo import History

LONGEST_POSE_NAME = 60
"""Of a pose [characters]."""


class PosesPanel(Panel):
    """The poses that have a name, and the file they are kept in.

    Args:
        robot: its joints take them.
        history: records that one is removed.
        remake: called when the poses have changed.
    """

    name = "poses"

    def __init__(
        self,
        poses: Presets,
        robot: RobotState,
        history: History,
        remake: Callable[[Panel], None],
    ) -> None:
        self.remade_by = (robot.changed,)
        self._poses = poses
        self._robot = robot
        self._history = history
        self._remake = remake

    def data(self) -> Sequence[Data]:
        """Return the names of the poses, and where they are kept."""
        if not self.offers("poses/use"):
            return ()
        names = list(self._poses.names)
        return [
            Data("poses/names", names),
            Data("poses/place", f"Saved {self._place()}."),
        ]

    def _place(self) -> str:
        path = self._poses.path
        return "in memory only" if path is None else f"in {path.absolute()}"

    def offers(self, command_id: str) -> bool:
        """Tell whether there are joints to pose."""
        joints = self._robot.joints
        return joints is not None and bool(joints.sliders)

    @command("poses/use", TEXT)
    def _use(self, name: str) -> Answer | None:
        left_out = self._robot.take_pose(name, self._poses.get(name))
        if left_out:
            return Answer(f"Without {', '.join(left_out)}, which cannot be set")
        return None

    @command("poses/save", TEXT)
    def _save(self, name: str) -> Answer:
        name, joints = name.strip(), self._robot.joints
        if joints is None:
            raise UsageError("there is no robot to save a pose of")
        if len(name) > LONGEST_POSE_NAME:
            raise UsageError(
                f"a pose's name has at most {LONGEST_POSE_NAME} characters"
            )
        poses = self._poses
        require_room(len({*poses.names, name}), MOST_POSES, "named poses")
        poses.save(name, joints.positions)
        self._remake(self)
        return Answer(f"Saved pose '{name}' {self._place()}")

    @command("poses/remove", TEXT)
    def _delete(self, name: str) -> Answer:
        poses = self._poses
        pose = poses.get(name)

        def change(action: Callable[[], None]) -> None:
            action()
            self._remake(self)

        save = partial(change, partial(poses.save, name, pose))
        remove = partial(change, partial(poses.remove, name))
        remove()
        label = f"Remove pose {name}"
        self._history.record(label, save, remove, of_document=False)
        return Answer(f"Removed pose '{name}'; Undo brings it back")

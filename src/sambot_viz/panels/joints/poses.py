"""Named poses: choose one, save one, remove one."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from sambot_viz.errors import UsageError
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.row import Answer, Row
from sambot_viz.session import Session
from sambot_viz.session.limits import MOST_POSES, require_room

LONGEST_NAME = 60
"""Of a pose [characters]."""


class PosesPanel(Panel):
    """The poses that have a name, and the file they are kept in.

    Args:
        session: whose joints take the poses.
        remake: called when the poses have changed.
    """

    name = "poses"

    def __init__(self, session: Session, remake: Callable[[Panel], None]) -> None:
        signals = session.signals
        self.remade_by = (signals.robot,)
        self._session = session
        self._remake = remake

    def rows(self) -> Sequence[Row]:
        """The list, and what can be done with it."""
        poses, joints = self._session.poses, self._session.joints
        if joints is None or not joints.sliders:
            return []
        return [
            Row("poses", "", "names", value=list(poses.names), help=self._place()),
            Row("poses/use", "", "action", takes=(str,), set=self._use),
            Row("poses/save", "", "action", takes=(str,), set=self._save),
            Row("poses/remove", "", "action", takes=(str,), set=self._delete),
        ]

    def _place(self) -> str:
        path = self._session.poses.path
        if path is None:
            return "Kept in memory only."
        return f"Kept in {path.absolute()}"

    def _use(self, arguments: tuple[str]) -> Answer | None:
        (name,) = arguments
        left_out = self._session.use_pose(name)
        if left_out:
            return Answer(f"Without {', '.join(left_out)}, which cannot be set")
        return None

    def _save(self, arguments: tuple[str]) -> Answer:
        name, joints = arguments[0].strip(), self._session.joints
        if joints is None:
            raise UsageError("there is no robot to save a pose of")
        if len(name) > LONGEST_NAME:
            raise UsageError(f"a pose's name has at most {LONGEST_NAME} characters")
        poses = self._session.poses
        require_room(len({*poses.names, name}), MOST_POSES, "named poses")
        poses.save(name, joints.positions)
        self._remake(self)
        where = f"in {poses.path.absolute()}" if poses.path else "in memory only"
        return Answer(f"Saved pose '{name}' {where}")

    def _delete(self, arguments: tuple[str]) -> Answer:
        (name,), poses = arguments, self._session.poses
        pose = poses.get(name)

        def change(action: Callable[[], None]) -> None:
            action()
            self._remake(self)

        save = partial(change, partial(poses.save, name, pose))
        remove = partial(change, partial(poses.remove, name))
        remove()
        label = f"Remove pose {name}"
        self._session.edits.record(label, save, remove, of_document=False)
        return Answer(f"Removed pose '{name}'; Undo brings it back")

"""What the robot of a session is compared with: another model, or the saved text."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from sambot_viz.robot.difference import Difference, differences
from sambot_viz.robot.ghost_links import GhostLink, ghost_links
from sambot_viz.robot.model import Robot
from sambot_viz.session.background import Background
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.scene.reference_ghost import ReferenceGhost
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.signals import Change, Signal, connect

Compared = Literal["none", "saved", "reference"]


@dataclass(frozen=True, slots=True)
class ComparisonChoice:
    """What users choose.

    Attributes:
        compared: with nothing, the text of the model that was saved last, or the
            reference.
        ghost: whether the links that differ are drawn.
        alpha: how opaque they are.
    """

    compared: Compared = "none"
    ghost: bool = True
    alpha: float = 0.5


class Comparison:
    """Compares the robot of a session, and draws the differences as a ghost.

    The comparison runs in a thread, and only after one of the two models has changed.

    Args:
        robot: the shown robot.
        scene: the scene that the ghost is drawn in.
        change: the session's changes.
        report: shows an internal error.
        choice: the first choice of what to compare.

    Attributes:
        changed: emitted when the choice or the differences change.
        choice: the users' choice.
        reference: the name of the reference; "" without one.
        found: the differences; None while there is nothing to compare.
        ghost: the drawn ghost.
    """

    def __init__(
        self,
        robot: RobotState,
        scene: Scene,
        change: Change,
        report: Callable[[Exception], object],
        choice: ComparisonChoice,
    ) -> None:
        self._robot, self._change, self._report = robot, change, report
        self.changed = Signal(change, None)
        self.choice = choice
        self.reference = ""
        self.found: Sequence[Difference] | None = None
        self.ghost = ReferenceGhost(scene, self._positions)
        self._reference: Robot | None = None
        self._saved: Robot | None = None
        self._compared: tuple[Robot | None, Robot | None] = (None, None)
        self._background = Background("sambot-viz-compare")
        self._closed = False
        connect([robot.changed], self._update)
        connect([scene.frames, scene.statuses], self._draw)
        connect([robot.positions], self._move)

    def close(self) -> None:
        """Compare nothing more."""
        self._closed = True

    def wait(self, timeout: float) -> bool:
        """Wait until all is compared; False when that takes longer [s]."""
        return self._background.wait(timeout)

    def choose(self, choice: ComparisonChoice) -> None:
        """Take another choice."""
        with self._change(self.changed):
            self.choice = choice
            self._draw()
        self._update()

    def take_reference(self, name: str, robot: Robot | None) -> None:
        """Take a reference, or the same after an edit.

        Args:
            name: what users call it.
            robot: the model; None while it cannot be read.
        """
        with self._change(self.changed):
            self.reference = name
            self._reference = robot or self._reference
        self._update()

    def take_saved(self, robot: Robot) -> None:
        """Take the model as its files on the disk say."""
        self._saved = robot
        self._update()

    @property
    def other(self) -> Robot | None:
        """The model that is compared with; None for none, or while it is not read."""
        models = {"saved": self._saved, "reference": self._reference}
        return models.get(self.choice.compared)

    @property
    def _wanted(self) -> tuple[Robot | None, Robot | None]:
        mine, other = self._robot.model, self.other
        return (None, None) if mine is None or other is None else (mine, other)

    def _update(self) -> None:
        """Compare again, unless neither model has changed; returns at once."""
        if not _are_same(self._wanted, self._compared):
            self._background.do(self, self._compare)

    def _compare(self) -> None:
        with self._change.lock:
            mine, other = pair = self._wanted
        found: Sequence[Difference] | None = None
        links: Sequence[GhostLink] = ()
        try:
            if mine is other:
                found = None if mine is None else ()
            elif mine is not None and other is not None:
                found = differences(mine, other)
                links = ghost_links(mine, other)
        except Exception as error:
            self._report(error)
        with self._change(self.changed):
            # What has come meanwhile has its turn next.
            if not self._closed and _are_same(pair, self._wanted):
                self._compared, self.found = pair, found
                self.ghost.take(other, links)
                self._draw()

    def _draw(self) -> None:
        alpha = self.choice.alpha if self.choice.ghost and not self._closed else 0.0
        if self.ghost.is_empty:
            return
        with self._change():
            self.ghost.draw(alpha)

    def _positions(self) -> Mapping[str, float]:
        joints = self._robot.joints
        return {} if joints is None else joints.positions

    def _move(self) -> None:
        if not self.ghost.is_still:
            with self._change():
                self.ghost.move()


def _are_same(one: Sequence[object], other: Sequence[object]) -> bool:
    return all(a is b for a, b in zip(one, other, strict=True))

"""Frames from messages: from /tf and /tf_static of a recording or a robot.

The history of frames answers look-ups at any time. This module sets the present pose of
each frame in the tree, so that it can be drawn.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from contextlib import suppress

from sambot_viz.errors import FrameError
from sambot_viz.frames import FrameTree
from sambot_viz.frames.frame_prefix import frame_prefix, joints_of
from sambot_viz.frames.history import transform_of
from sambot_viz.frames.samples import Sample
from sambot_viz.robot.model import Robot


class DataFrames:
    """The latest pose of each frame of a history, in the tree that is drawn.

    Args:
        tree: where they are set, with the history that has them, if it has one; the
            session that owns it holds the lock.

    Attributes:
        tree: as given.
        changed: the frames that were told of since it was called last.
        waiting: whether there may be some.
        pairs: gives the (parent, child) that messages are known to join.
        prefix: returns what messages put before the links of a robot.
        ahead: gives the first sample of each frame whose messages are still to come.
        refused: frame → why it cannot be set, such as a ring.
    """

    def __init__(self, tree: FrameTree) -> None:
        self.changed: Callable[[], Collection[str]] = tuple[str, ...]
        self.waiting = False
        self.pairs: Callable[[], Iterable[tuple[str, str]]] = tuple[
            tuple[str, str], ...
        ]
        self.prefix: Callable[[Robot], str] = lambda robot: frame_prefix(
            joints_of(robot), self.pairs()
        )
        self.ahead: Callable[[], Mapping[str, Sample]] = dict[str, Sample]
        self.refused: dict[str, str] = {}
        self.tree = tree
        self._history = tree.history
        self._left_out = frozenset[str]()
        self._known: dict[str, None] = {}
        self._set_at: int | None = None

    def __contains__(self, frame: object) -> bool:
        return frame in self._known and frame not in self._left_out

    @property
    def has_history(self) -> bool:
        """Whether there are messages at all."""
        return self._history is not None

    def leave_to_joints(self, robot: Robot | None) -> None:
        """Let the joints of a robot hold its links, whatever messages say of them.

        The tree is to be built again. Frames are then looked up where they are now, and
        at no other time. None ends it.
        """
        prefix = "" if robot is None else self.prefix_of(robot)
        joints = () if robot is None else joints_of(robot)
        self._left_out = frozenset(prefix + child for _, child in joints)
        self.tree.history = self._history if robot is None else None

    def forget_all(self) -> None:
        """Know no frame, as at the start; the tree is to be built again."""
        self._left_out, self.tree.history = frozenset[str](), self._history
        self._known.clear()
        self.refused.clear()
        self.waiting = False
        if self._history is not None:
            self._history.forget_all()

    def settle(self) -> Collection[str]:
        """Set the frames that have moved in the tree.

        Returns:
            Their names.
        """
        self.waiting = False
        changed = self.changed()
        at = None if self._history is None else self._history.shown_at
        if at != self._set_at:
            # All that moves is somewhere else at another time.
            self._set_at = at
            changed = {**dict.fromkeys(changed), **self._known}.keys()
        self._set(changed)
        return changed

    def set_again(self) -> None:
        """Set all of them in a tree that was cleared.

        Frames that have no place at present are known all the same, as in tf2. Those
        whose first message is still to come are drawn where that has them.
        """
        for frame in self._history.frames if self._history is not None else ():
            self.tree.declare(frame)
        self._set(tuple(self._known))
        # Without a history a look-up would take them for known.
        ahead = dict[str, Sample]() if self.tree.history is None else self.ahead()
        for child, first in ahead.items():
            with suppress(FrameError):
                self.tree.set_ahead(first.parent, child, transform_of(first.pose))

    def places_links(self, robot: Robot) -> bool:
        """Return whether messages say where the links of a robot are."""
        if self._left_out:
            return False
        prefix, joints = self.prefix_of(robot), joints_of(robot)
        named = {(prefix + parent, prefix + child) for parent, child in joints}
        return not named.isdisjoint(self.pairs())

    def prefix_of(self, robot: Robot) -> str:
        """Return what messages put before the links of a robot, such as "robot1/"."""
        return self.prefix(robot)

    def after_jump(self) -> bool:
        """Return whether frames have gone that were there before a jump in time."""
        history = self._history
        if history is None:
            return False
        gone = [child for child in self._known if history.latest(child) is None]
        for child in gone:
            del self._known[child]
        return bool(gone)

    def _set(self, frames: Collection[str]) -> None:
        history, tree = self._history, self.tree
        if history is None:
            return
        for child in frames:
            sample = history.shown(child)
            if sample is None:
                continue
            if child in self._left_out:
                # What was published once is not told of again.
                self._known[child] = None
                continue
            transform = transform_of(sample.pose)
            try:
                if history.is_static(child):
                    tree.set_static(sample.parent, child, transform)
                else:
                    tree.set(sample.parent, child, transform, sample.stamp * 1e-9)
            except FrameError as error:
                self.refused[child] = str(error)
                tree.declare(child)
                continue
            self._known[child] = None

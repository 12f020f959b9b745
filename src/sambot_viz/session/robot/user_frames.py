"""Frames that a user adds to the robot's: static transforms, odom.

They outlive a reload of the robot, whose own frames are set again every time.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from sambot_viz.errors import FrameError, Problem
from sambot_viz.frames import FrameTree, Transform
from sambot_viz.frames.hierarchy import plain_name


@dataclass(frozen=True, slots=True)
class UserFrame:
    """A frame added by a user: `transform` is T_parent_child."""

    parent: str
    transform: Transform
    static: bool


class UserFrames:
    """The added frames of one tree, by the name of the child.

    Args:
        tree: where they are set; the session that owns both holds the lock.
    """

    def __init__(self, tree: FrameTree) -> None:
        self._tree = tree
        self._added: dict[str, UserFrame] = {}

    def __getitem__(self, child: str) -> UserFrame:
        return self._added[plain_name(child)]

    def __contains__(self, child: object) -> bool:
        return isinstance(child, str) and plain_name(child) in self._added

    @property
    def all(self) -> Mapping[str, UserFrame]:
        """Child → the added frame, in the order in which they came; read-only."""
        return MappingProxyType(self._added)

    def set(
        self, parent: str, child: str, transform: Transform, *, static: bool = True
    ) -> None:
        """Add a frame, or give it another pose or parent.

        Raises:
            TransformRefused: an empty name, or parent and child are the same.
            FrameCycleError: the parent is a descendant of the child.
        """
        set_it = self._tree.set_static if static else self._tree.set
        set_it(parent, child, transform)
        added = UserFrame(plain_name(parent), transform, static)
        self._added[plain_name(child)] = added

    def moved(self, child: str, transform: Transform) -> None:
        """Remember the pose that an added frame now has in the tree."""
        added = self._added.get(child)
        if added is not None:
            self._added[child] = UserFrame(added.parent, transform, added.static)

    def forget(self, child: str) -> None:
        """Forget an added frame; remove it from the tree if its parent is unchanged.

        Raises:
            FrameError: that frame was not added.
        """
        child = plain_name(child)
        added = self._added.pop(child, None)
        if added is None:
            raise FrameError(f"no frame '{child}' was added; it cannot be removed")
        if self._tree.parent(child) == added.parent:
            self._tree.remove(child)

    def set_again(self) -> tuple[Problem, ...]:
        """Set all of them in a tree that was cleared.

        Returns:
            Why some could not be set; those are forgotten.
        """
        problems: list[Problem] = []
        for child, added in list(self._added.items()):
            try:
                self.set(added.parent, child, added.transform, static=added.static)
            except FrameError as error:
                del self._added[child]
                problems.append(Problem("warning", "static-transform", str(error)))
        return tuple(problems)

"""The frames of a session, for look-ups from any thread of a program."""

from __future__ import annotations

import threading
from collections.abc import Sequence

from sambot_viz.frames import FrameTree, Transform


class FrameView:
    """Reads the frames that a session shows; each answer is of one moment.

    Args:
        tree: the frames.
        lock: the session's; held while the tree is read.
    """

    def __init__(self, tree: FrameTree, lock: threading.RLock) -> None:
        self._tree = tree
        self._lock = lock

    def __contains__(self, frame: object) -> bool:
        with self._lock:
            return frame in self._tree

    @property
    def frames(self) -> Sequence[str]:
        """The names of all frames."""
        with self._lock:
            return tuple(self._tree.frames)

    def parent(self, frame: str) -> str | None:
        """The frame that holds this one; None for a root.

        Raises:
            FrameError: the frame does not exist.
        """
        with self._lock:
            return self._tree.parent(frame)

    def lookup(self, target: str, source: str) -> Transform:
        """The pose of the source frame in the target frame, T_target_source.

        Raises:
            LookupRefused: a frame that does not exist, or frames of separate trees.
        """
        with self._lock:
            return self._tree.lookup(target, source)

    def can_lookup(self, target: str, source: str) -> bool:
        """Whether `lookup` has an answer."""
        with self._lock:
            return self._tree.can_lookup(target, source)

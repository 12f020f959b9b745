"""The frames of a session: adding and removing them, and look-ups from any thread."""

from __future__ import annotations

import threading
from collections.abc import Mapping, Sequence

from sambot_viz.frames import FrameTree, Transform
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.robot.user_frames import UserFrame, UserFrames
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.signals import Change
from sambot_viz.session.undo import History


class Frames:
    """The frames of a robot, and those that users add.

    Args:
        tree: all of them.
        user_frames: those that were added.
        robot: its frames are set again where an added one was.

    Attributes:
        tree: all of them.
    """

    def __init__(
        self,
        tree: FrameTree,
        user_frames: UserFrames,
        robot: RobotState,
        scene: Scene,
        history: History,
        change: Change,
    ) -> None:
        self.tree = tree
        self._user_frames = user_frames
        self._robot = robot
        self._scene = scene
        self._history = history
        self._change = change

    @property
    def added(self) -> Mapping[str, UserFrame]:
        """Child → the added frame, in the order in which they came; read-only."""
        return self._user_frames.all

    def add(
        self, parent: str, child: str, transform: Transform, *, static: bool = True
    ) -> None:
        """Add a frame, or give an added one another pose or parent.

        Args:
            parent: the frame it is attached to.
            child: the frame.
            transform: T_parent_child.
            static: False for a frame that moves (`RobotState.move`), such as odom's
                child.

        Raises:
            FrameError: parent and child are the same, or would form a ring.
        """
        before = self.added.get(plain_name(child))
        self._set(child, UserFrame(parent, transform, static))
        if static:
            self._record(f"Add frame {child}", child, before)

    def remove(self, child: str) -> None:
        """Remove an added frame.

        Raises:
            FrameError: that frame was not added.
        """
        before = self.added.get(plain_name(child))
        self._set(child, None)
        self._record(f"Remove frame {child}", child, before)

    def _record(self, label: str, child: str, before: UserFrame | None) -> None:
        after = self.added.get(plain_name(child))
        self._history.record(
            label,
            lambda: self._set(child, before),
            lambda: self._set(child, after),
            ("frame", plain_name(child)),
            of_document=False,
        )

    def _set(self, child: str, frame: UserFrame | None) -> None:
        """Add a frame, or change it; None removes it."""
        with self._change():
            if frame is not None:
                parent, transform = frame.parent, frame.transform
                self._user_frames.set(parent, child, transform, static=frame.static)
                self._robot.forget_pose(child)
            else:
                self._user_frames.forget(child)
                self._robot.forget_pose(child)
                # A joint of the robot may hold that frame again.
                self._robot.build_tree()
            self._scene.draw_frames()


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

"""The joints and frames of a session's robot, as users and programs move them.

What a user does is recorded (see `undo`). A program that moves joints sixty times a
second pays nothing for that.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

from sambot_viz.displays.robot_display import ModelReader
from sambot_viz.displays.scene.session_assets import Reader
from sambot_viz.frames import Transform
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.geometry import Matrix
from sambot_viz.joints import JointState
from sambot_viz.joints.presets import Presets
from sambot_viz.meshes.cache import MeshCache
from sambot_viz.robot.model import Robot
from sambot_viz.rviz import RvizConfig
from sambot_viz.session.document.display_edits import DisplayEdits
from sambot_viz.session.robot.past_motion import PastMotion
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.robot.user_frames import UserFrame, UserFrames
from sambot_viz.session.signals import Audience
from sambot_viz.session.throttle import Throttle
from sambot_viz.session.worker import Worker


class RobotEdits(DisplayEdits):
    """Base of `Session`: the robot, its joints, and the frames that users add.

    Args:
        audience: where to draw.
        worker: the thread that browsers, timers and files act in.
        config: the .rviz document.
        meshes: mesh files that are read already.
        models: reads other models, for a RobotModel from a file.
        reader: reads mesh files in the background; None reads them while drawing.
        poses: the named poses.

    Attributes:
        poses: the named poses.
        added: the frames that were added.
    """

    def __init__(
        self,
        audience: Audience,
        worker: Worker,
        config: RvizConfig,
        meshes: MeshCache,
        models: ModelReader | None,
        reader: Reader | None,
        poses: Presets,
    ) -> None:
        super().__init__(audience, worker, config, meshes, models, reader)
        self.poses = poses
        self.added = UserFrames(self.tree)
        self._posed = RobotState(self.tree, self.added)
        self._pacer = Throttle(worker, self.period, self.draw_moved)

    @property
    def robot(self) -> Robot | None:
        """What is shown, or None before the first robot."""
        return self._posed.robot

    @property
    def joints(self) -> JointState | None:
        """The positions of its joints; move them with the methods of the session."""
        return self._posed.joints

    @property
    def first_positions(self) -> Mapping[str, float]:
        """Joint → its position before anything has moved it [rad or m]."""
        return self._posed.first

    @property
    def joints_moved(self) -> bool:
        """Whether anything has moved a joint since the start."""
        return self._posed.moved

    @property
    def past(self) -> PastMotion:
        """How joints and driven frames have moved lately."""
        return self._posed.past

    # Joints

    def set_joint_positions(
        self, positions: Mapping[str, float], label: str = ""
    ) -> None:
        """Move some joints, as an edit that can be undone; see `move`."""
        names = tuple(positions)
        label = label or (f"Move {names[0]}" if len(names) == 1 else "Move joints")
        self._move_joints(label, partial(self._posed.move, positions, {}), names)

    def use_pose(self, name: str) -> tuple[str, ...]:
        """Move the joints to a named pose.

        Returns:
            The joints of the pose that cannot be set in this robot.

        Raises:
            JointError: an unknown pose.
        """
        pose = self.poses.get(name)
        free = self.joints.free if self.joints is not None else ()
        known = {joint: pose[joint] for joint in pose if joint in free}
        self._move_joints(f"Pose {name}", partial(self._posed.move, known, {}))
        return tuple(joint for joint in pose if joint not in known)

    def move(
        self, positions: Mapping[str, float], frames: Mapping[str, Matrix]
    ) -> None:
        """Move some joints and some added frames, drawn together.

        Args:
            positions: joint → position [rad or m].
            frames: added frame → (4, 4) T_parent_child; kept, not copied.

        Raises:
            JointError: an unknown joint, a follower, or no finite number.
        """
        with self.lock:
            self._posed.move(positions, frames)
        self._pacer.request()

    def center_joints(self) -> None:
        """Move all joints to their start values."""
        self._move_joints("Center the joints", self._posed.center)

    def randomize_joints(self, seed: int | None = None) -> None:
        """Move all joints to random values of their ranges."""
        self._move_joints("Randomize the joints", lambda: self._posed.randomize(seed))

    def _move_joints(
        self, label: str, move: Callable[[], None], merge: tuple[str, ...] | None = None
    ) -> None:
        """Move joints; where they were is noted only for a browser that may undo it."""
        recording, joints = self.history.recording, self.joints
        before = dict(joints.positions) if recording and joints is not None else {}
        with self.lock:
            move()
        self._pacer.request()
        if recording and joints is not None:
            after = {n: q for n, q in joints.positions.items() if before.get(n) != q}
            before = {name: before[name] for name in after}
            if after:
                self.history.record(
                    label,
                    partial(self.move, before, {}),
                    partial(self.move, after, {}),
                    merge and ("joints", *merge),
                    of_document=False,
                )

    # Frames

    def add_frame(
        self, parent: str, child: str, transform: Transform, *, static: bool = True
    ) -> None:
        """Add a frame, or give an added one another pose or parent.

        Args:
            parent: the frame it is attached to.
            child: the frame.
            transform: T_parent_child.
            static: False for a frame that moves (see `move`), such as odom's child.

        Raises:
            FrameError: parent and child are the same, or would form a ring.
        """
        before = self.added.all.get(plain_name(child))
        self._set_frame(child, UserFrame(parent, transform, static))
        if static:
            self._record_frame(f"Add frame {child}", child, before)

    def remove_frame(self, child: str) -> None:
        """Remove an added frame.

        Raises:
            FrameError: that frame was not added.
        """
        before = self.added.all.get(plain_name(child))
        self._set_frame(child, None)
        self._record_frame(f"Remove frame {child}", child, before)

    def _record_frame(self, label: str, child: str, before: UserFrame | None) -> None:
        after = self.added.all.get(plain_name(child))
        self.history.record(
            label,
            lambda: self._set_frame(child, before),
            lambda: self._set_frame(child, after),
            ("frame", plain_name(child)),
            of_document=False,
        )

    def _set_frame(self, child: str, frame: UserFrame | None) -> None:
        """Add a frame, or change it; None removes it."""
        with self.change(self.signals.frames):
            if frame is not None:
                parent, transform = frame.parent, frame.transform
                self.added.set(parent, child, transform, static=frame.static)
                self._posed.forget_pose(child)
            else:
                self.added.forget(child)
                self._posed.forget_pose(child)
                # A joint of the robot may hold that frame again.
                self._posed.build_tree()
                self.drawn.publish()
            self._frames_changed()

    def draw_moved(self) -> None:
        """Send the poses of all that moved since the last time; `move` does it soon."""
        with self.lock:
            frames = self._posed.settle()
            if not frames:
                return
            with self.audience.atomic():
                self.drawn.place(frames.keys())
            # The poses are sent before any panel is notified.
            self.audience.flush()
            self.signals.joints.touch()

    def _period_changed(self) -> None:
        self._pacer.period = self.period

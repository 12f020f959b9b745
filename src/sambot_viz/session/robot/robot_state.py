"""The robot of a session, the positions of its joints, and the frames they move."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from functools import partial

from sambot_viz.errors import JointError, Problem
from sambot_viz.frames import FrameTree, Transform
from sambot_viz.frames.data_frames import DataFrames
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.frames.robot_frames import hang_robot
from sambot_viz.geometry import Matrix
from sambot_viz.joints import JointState
from sambot_viz.joints.animation import wrap_angle
from sambot_viz.joints.presets import StartPose
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Joint
from sambot_viz.session.robot.motion_recorder import MotionRecorder
from sambot_viz.session.robot.user_frames import UserFrames
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.signals import Change, Signal
from sambot_viz.session.undo import History, NotNow
from sambot_viz.session.worker import Throttle, Worker
from sambot_viz.topics.robot_topics import STAND_IN_NAME


class RobotState:
    """The shown robot, and the methods by which users and programs move it.

    Moves by users are recorded for undo; a program that moves joints sixty times a
    second does not pay for that. A single move is drawn at once, a stream at the Frame
    Rate.

    Args:
        tree: the frames; this class fills it.
        added: frames that were added by hand or by driving.
        data: frames from messages; they override the robot's joints.

    Attributes:
        changed: emitted when another robot is shown, or the same after an edit.
        positions: emitted when joint positions or poses of frames change.
        model: the shown robot; None before the first.
        joints: the positions of its joints; move them with the methods of this class.
        first: joint → its position before any move [rad or m].
        moved: whether a joint was moved.
        leads: whether its joints are published to a live robot, so that the messages
            that come back do not move them.
        followed: the source whose messages move the joints, such as a recording; ""
            while users and programs do.
        recorder: the latest motion of joints and frames.
    """

    def __init__(
        self,
        tree: FrameTree,
        added: UserFrames,
        data: DataFrames,
        scene: Scene,
        history: History,
        change: Change,
        worker: Worker,
    ) -> None:
        self.changed = Signal(change, None)
        self.positions = Signal(change, None)
        self.model: Robot | None = None
        self.joints: JointState | None = None
        self.first: dict[str, float] = {}
        self.moved = False
        self.followed = Signal(change, "")
        self.leads = False
        self.recorder = MotionRecorder(worker.clock)
        self._tree = tree
        self._added = added
        self._data = data
        self._scene = scene
        self._history = history
        self._change = change
        self._pacer = Throttle(worker, 0.0, self.draw_moved)
        self._is_placed = False
        # By joint: the frame that it moves.
        self._frame_of: dict[str, str] = {}
        self._moved: dict[str, None] = {}
        self._new_poses: dict[str, Matrix] = {}

    def take(self, model: Robot, start: StartPose) -> tuple[Problem, ...]:
        """Take a robot, or the same after an edit: joints keep their values.

        Args:
            model: the robot.
            start: where the joints of the first one with joints are.

        Returns:
            Why some of the added frames could not be set.
        """
        self.model = model
        if self.joints is None or not self.joints.joints:
            self.joints = start.state(model)
        else:
            self.joints.reload(model)
        known = self.first
        self.first = {n: known.get(n, q) for n, q in self.joints.positions.items()}
        self.recorder.clear(self.joints.positions)
        # The tree is built with these positions; joints that moved may be gone.
        self._moved.clear()
        joints = model.joints.values()
        moving = {plain_name(j.child): j.type for j in joints if j.movable}
        self._scene.take_robot(model, moving)
        refused = self.build_tree()
        self.changed.touch()
        return refused

    def forget(self) -> None:
        """Show no robot, as at the start; frames that were added stay."""
        self.model = self.joints = None
        self.first, self.moved = {}, False
        self._moved.clear()
        self._new_poses.clear()
        self.followed.set("")
        self._scene.context.robot = None
        self._tree.clear()

    def build_tree(self) -> tuple[Problem, ...]:
        """Set the frames of the robot, then the added ones and those of displays.

        Returns:
            Why some of the added frames could not be set.
        """
        if self.model is None or self.joints is None:
            return ()
        self._tree.clear()
        self._is_placed = self._data.places_links(self.model)
        # A link of which messages say nothing then has no place, as in RViz.
        joints = () if self._is_placed else None
        kinematics, positions = self.joints.kinematics, self.joints.positions
        prefix = self._data.prefix_of(self.model)
        self._frame_of = {
            name: prefix + plain_name(joint.child)
            for name, joint in self.model.joints.items()
        }
        # The frames of a placeholder for a robot to come are published by no node.
        if self.model.name != STAND_IN_NAME:
            hang_robot(self._tree, self.model, kinematics, positions, joints, prefix)
        refused = self._added.set_again()
        self._data.set_again()
        self._scene.publish()
        return refused

    @property
    def has_messages(self) -> bool:
        """Whether messages say where frames are."""
        return self._data.has_history

    def set_period(self, period: float) -> None:
        """Set the shortest time between two pictures of a stream [s]."""
        self._pacer.period = period

    def close(self) -> None:
        """Stop drawing for good."""
        self._pacer.close()

    def joint_of(self, frame: str) -> Joint | None:
        """Return the joint that moves a link: its own, or the next one above it."""
        robot = self.model
        if robot is None:
            return None
        above = {plain_name(joint.child): joint for joint in robot.joints.values()}
        joint = above.get(plain_name(frame))
        while joint is not None and not joint.movable:
            joint = above.get(plain_name(joint.parent))
        return joint

    # What users do

    def set_followed(self, name: str) -> None:
        """Let the messages of a recording move the joints; "" gives them to users."""
        with self._change(self.followed):
            self.followed.set(name)
            self._data.leave_to_joints(None if name else self.model)
            self.build_tree()

    def require_free(self) -> None:
        """Raise JointError while messages move the joints."""
        if self.followed.value:
            raise JointError(
                f"the joints are moved by {self.followed.value}; switch Follow off in "
                "Joints to move them yourself"
            )

    def set_positions(self, positions: Mapping[str, float], label: str = "") -> None:
        """Move some joints, as an edit that can be undone; see `move`.

        Raises:
            JointError: as `move`, and while messages move them.
        """
        self.require_free()
        names = tuple(positions)
        label = label or (f"Move {names[0]}" if len(names) == 1 else "Move joints")
        move = partial(self._note, positions, {})
        self._edit(label, move, names, ("joints", *names))

    def take_pose(
        self,
        name: str,
        pose: Mapping[str, float],
        glide: Callable[[Mapping[str, float]], None] | None = None,
    ) -> tuple[str, ...]:
        """Move the joints to a named pose.

        Args:
            name: of the pose.
            pose: joint → position [rad or m].
            glide: moves the joints there, step by step; without it they jump.

        Returns:
            The joints of the pose that cannot be set in this robot.
        """
        self.require_free()
        free = self.joints.free if self.joints is not None else ()
        known = {joint: q for joint, q in pose.items() if joint in free}
        if glide is None:
            self._edit(f"Pose {name}", partial(self._note, known, {}), known)
        elif self.joints is not None:
            now = self.joints.positions
            after = {n: q for n, q in known.items() if now[n] != q}
            before = {n: now[n] for n in after}
            if after:
                glide(after)
                self._history.record(
                    f"Pose {name}",
                    partial(self.move_again, before),
                    partial(self.move_again, after),
                    of_document=False,
                )
        return tuple(joint for joint in pose if joint not in known)

    def center(self) -> None:
        """Move all joints to their start values."""
        self.require_free()
        self._edit("Center the joints", lambda: self._note_all(JointState.center))

    def randomize(self, seed: int | None = None) -> None:
        """Move all joints to random values of their ranges."""
        self.require_free()
        self._edit(
            "Randomize the joints",
            lambda: self._note_all(lambda joints: joints.randomize(seed)),
        )

    def _edit(
        self,
        label: str,
        move: Callable[[], None],
        names: Collection[str] | None = None,
        merge: tuple[str, ...] | None = None,
    ) -> None:
        """Move joints, all or those of some names.

        Where they were is noted only for a client that may undo it.
        """
        with self._change.lock:
            recording, joints = self._history.recording, self.joints
            before: dict[str, float] = {}
            if recording and joints is not None:
                known, some = joints.positions, joints.free if names is None else names
                before = {name: known[name] for name in some if name in known}
            move()
        self._pacer.request()
        if recording and joints is not None:
            now = joints.positions
            after = {name: now[name] for name in before if now[name] != before[name]}
            before = {name: before[name] for name in after}
            if after:
                self._history.record(
                    label,
                    partial(self.move_again, before),
                    partial(self.move_again, after),
                    merge,
                    of_document=False,
                )

    def move_again(self, positions: Mapping[str, float]) -> None:
        """Move some joints to undo a step, or to do it again.

        Raises:
            NotNow: messages move them.
            JointError: as `move`.
        """
        try:
            self.require_free()
        except JointError as error:
            raise NotNow(str(error)) from None
        self.move(positions, {})

    # What moves by itself

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
        with self._change.lock:
            self._note(positions, frames)
        self._pacer.request()

    def note_followed(self, positions: Mapping[str, float]) -> None:
        """Store positions from messages, for `draw_moved`.

        Args:
            positions: joint → position [rad or m], finite; names that are no free joint
                are ignored.
        """
        with self._change.lock:
            joints = self.joints
            if joints is not None and self.followed.value:
                known = {
                    name: q for name, q in positions.items() if name in joints.free
                }
                for name in known:
                    # A wheel that has driven for an hour has turned a thousand times.
                    if joints.joints[name].endless:
                        known[name] = wrap_angle(known[name])
                self._note(known, {})

    def starts(self, names: Collection[str]) -> dict[str, float]:
        """Return joint → start value of those that are free joints [rad or m]."""
        joints = self.joints
        if joints is None:
            return {}
        return {name: joints.start(name) for name in names if name in joints.free}

    def after_jump(self) -> None:
        """Draw what messages say after a jump in time; some frames may be gone."""
        with self._change(self.positions):
            if self._data.after_jump():
                self.build_tree()
            self.draw_moved()

    def time_passed(self) -> None:
        """Let frames grow old that messages bring no more."""
        self._scene.time_passed()

    def messages_came(self) -> None:
        """Let displays draw what has come for them."""
        self._scene.messages_came()

    def draw_moved(self) -> None:
        """Send the poses of all that moved since the last time; `move` does it soon."""
        with self._change.lock:
            if not (self._data.waiting or self._moved or self._new_poses):
                return
            with self._change(self.positions):
                version = self._tree.version
                frames = {*self._settle(), *self._data.settle()}
                if self._tree.version != version and self._is_placed_otherwise():
                    self.build_tree()
                # The end of the change draws frames that are new or hang elsewhere.
                if self._tree.version == version:
                    self._scene.place(frames)

    def _is_placed_otherwise(self) -> bool:
        """Return whether messages have begun to say where the links are."""
        model = self.model
        return model is not None and self._is_placed != self._data.places_links(model)

    def _note(
        self, positions: Mapping[str, float], frames: Mapping[str, Matrix]
    ) -> None:
        """Note new positions of joints and poses of added frames, to be drawn."""
        if self.joints is not None:
            self._note_moved(self.joints.set_all(positions))
        self._new_poses.update(frames)

    def _note_all(self, move: Callable[[JointState], Iterable[str]]) -> None:
        if self.joints is not None:
            self._note_moved(move(self.joints))

    def forget_pose(self, frame: str) -> None:
        """Drop a noted pose, because the frame is set again or removed."""
        self._new_poses.pop(plain_name(frame), None)

    def _settle(self) -> dict[str, Matrix]:
        """Set all noted changes in the tree.

        Returns:
            Child frame → (4, 4) T_parent_child of what changed since the last time.
        """
        moved, self._moved = self._moved, {}
        poses, self._new_poses = self._new_poses, {}
        for frame in poses:
            self.recorder.begin(frame, self._added[frame].transform.matrix)
        if self.joints is not None and (moved or poses):
            self.recorder.note(moved, self.joints.positions, poses)
        frames = {**self._joint_frames(moved), **poses}
        if frames:
            self._tree.update(frames)
        for frame, T in poses.items():
            # It is kept here and by the recorder.
            T.flags.writeable = False
            self._added.moved(frame, Transform.trusted(T))
        return frames

    def _note_moved(self, joints: Iterable[str]) -> None:
        self._moved.update(dict.fromkeys(joints))
        self.moved = self.moved or bool(self._moved)

    def _joint_frames(self, moved: Iterable[str]) -> dict[str, Matrix]:
        joints, frame_of = self.joints, self._frame_of
        if joints is None or self._is_placed:
            return {}
        # A frame that a user attached elsewhere no longer follows its joint, nor does
        # one of which messages say where it is.
        added, data = self._added, self._data
        if added.all or data.has_history:
            frames = ((name, frame_of[name]) for name in moved)
            moved = [n for n, f in frames if f not in added and f not in data]
        return {frame_of[name]: T for name, T in joints.transforms(moved).items()}

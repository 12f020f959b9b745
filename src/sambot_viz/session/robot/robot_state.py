"""The robot of a session, the positions of its joints, and the frames they move."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from sambot_viz.errors import Problem
from sambot_viz.frames import FrameTree, Transform
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.frames.robot_frames import hang_robot
from sambot_viz.geometry import Matrix
from sambot_viz.joints import JointState
from sambot_viz.joints.start import StartPose
from sambot_viz.robot.model import Robot
from sambot_viz.session.robot.past_motion import PastMotion
from sambot_viz.session.robot.user_frames import UserFrames


class RobotState:
    """What a session shows of a robot; not thread-safe, the session holds the lock.

    Args:
        tree: the frames; this fills them.
        added: frames that were added by hand or by driving.

    Attributes:
        robot: what is shown, or None before the first robot.
        joints: the positions of its joints.
        first: joint → its position before anything has moved it [rad or m].
        moved: whether anything has moved a joint.
        past: how joints and frames have moved lately.
    """

    def __init__(self, tree: FrameTree, added: UserFrames) -> None:
        self.robot: Robot | None = None
        self.joints: JointState | None = None
        self.first: dict[str, float] = {}
        self.moved = False
        self.past = PastMotion()
        self._tree = tree
        self._added = added
        self._moved: dict[str, None] = {}
        self._new_poses: dict[str, Matrix] = {}

    def take(self, robot: Robot, start: StartPose) -> None:
        """Take a robot, or the same after an edit: joints keep their values."""
        self.robot = robot
        if self.joints is None:
            self.joints = start.state(robot)
        else:
            self.joints.reload(robot)
        known = self.first
        self.first = {n: known.get(n, q) for n, q in self.joints.positions.items()}
        self.past.clear(self.joints.positions)

    def build_tree(self) -> tuple[Problem, ...]:
        """Set the frames of the robot, then the added ones; returns refused ones."""
        if self.robot is None or self.joints is None:
            return ()
        self._tree.clear()
        hang_robot(
            self._tree, self.robot, self.joints.kinematics, self.joints.positions
        )
        return self._added.set_again()

    @property
    def moving(self) -> dict[str, str]:
        """Child frame → the type of the joint that moves it."""
        joints = self.robot.joints.values() if self.robot else ()
        return {plain_name(j.child): j.type for j in joints if j.movable}

    def move(
        self, positions: Mapping[str, float], frames: Mapping[str, Matrix]
    ) -> None:
        """Note new positions of joints and poses of added frames, for `settle`.

        Args:
            positions: joint → position [rad or m].
            frames: added frame → (4, 4) T_parent_child; kept, not copied.

        Raises:
            JointError: an unknown joint, a follower, or no finite number.
        """
        if self.joints is not None:
            self._note(self.joints.set_all(positions))
        self._new_poses.update(frames)

    def center(self) -> None:
        """Note the start values of all joints."""
        if self.joints is not None:
            self._note(self.joints.center())

    def randomize(self, seed: int | None) -> None:
        """Note random values of all joints."""
        if self.joints is not None:
            self._note(self.joints.randomize(seed))

    def forget_pose(self, frame: str) -> None:
        """Drop a noted pose, because the frame is set again or removed."""
        self._new_poses.pop(plain_name(frame), None)

    def settle(self) -> dict[str, Matrix]:
        """Set all noted changes in the tree.

        Returns:
            Child frame → (4, 4) T_parent_child of what changed since the last time.
        """
        moved, self._moved = self._moved, {}
        poses, self._new_poses = self._new_poses, {}
        for frame in poses:
            self.past.begin(frame, self._added[frame].transform.matrix)
        if self.joints is not None and (moved or poses):
            self.past.note(moved, self.joints.positions, poses)
        frames = {**self._joint_frames(moved), **poses}
        if frames:
            self._tree.update(frames)
        for frame, T in poses.items():
            self._added.moved(frame, Transform.trusted(T))
        return frames

    def _note(self, joints: Iterable[str]) -> None:
        self._moved.update(dict.fromkeys(joints))
        self.moved = self.moved or bool(self._moved)

    def _joint_frames(self, moved: Iterable[str]) -> dict[str, Matrix]:
        robot, joints = self.robot, self.joints
        if robot is None or joints is None:
            return {}
        frames = {name: plain_name(robot.joints[name].child) for name in moved}
        # A frame that a user attached elsewhere no longer follows its joint.
        free = [name for name, frame in frames.items() if frame not in self._added]
        return {frames[name]: T for name, T in joints.transforms(free).items()}

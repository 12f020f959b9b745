"""The robot of a session, the positions of its joints, and the frames they move."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from sambot_viz.errors import Problem
from sambot_viz.frames import FrameTree, Transform
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.geometry import Matrix
from sambot_viz.joints import JointState
from sambot_viz.joints.start import StartPose
from sambot_viz.robot.kinematics import Kinematics
from sambot_viz.robot.model import Robot
from sambot_viz.session.user_frames import UserFrames


class RobotState:
    """See the module. Not thread-safe: the session that owns it holds the lock.

    Args:
        tree: the frames; this fills them.
        added: frames that were added by hand or by driving.

    Attributes:
        robot: what is shown, or None before the first robot.
        joints: the positions of its joints.
    """

    def __init__(self, tree: FrameTree, added: UserFrames) -> None:
        self.robot: Robot | None = None
        self.joints: JointState | None = None
        self._tree = tree
        self._added = added
        self._kinematics: Kinematics | None = None
        self._moved: dict[str, None] = {}
        self._swept: dict[str, Matrix] = {}

    def take(self, robot: Robot, start: StartPose) -> None:
        """Take a robot, or the same after an edit: joints keep their values."""
        self.robot = robot
        self._kinematics = Kinematics(robot)
        if self.joints is None:
            self.joints = start.state(robot)
        else:
            self.joints.reload(robot)

    def build_tree(self) -> tuple[Problem, ...]:
        """The frames of the robot, then the added ones again; why some cannot be."""
        robot, kinematics, joints = self.robot, self._kinematics, self.joints
        if robot is None or kinematics is None or joints is None:
            return ()
        positions = joints.all_positions()
        self._tree.clear()
        self._tree.declare(robot.root)
        for name, joint in robot.joints.items():
            T = kinematics.joint_transform(name, positions.get(name, joint.start))
            set_transform = self._tree.set if joint.movable else self._tree.set_static
            set_transform(joint.parent, joint.child, Transform.trusted(T))
        return self._added.set_again()

    @property
    def moving(self) -> dict[str, str]:
        """Child frame → the type of the joint that moves it."""
        joints = self.robot.joints.values() if self.robot else ()
        return {plain_name(j.child): j.type for j in joints if j.movable}

    def mark(self, joints: Iterable[str]) -> None:
        """Note that some joints have other positions than their frames show."""
        self._moved.update(dict.fromkeys(joints))

    def sweep(self, frames: Mapping[str, Matrix]) -> None:
        """Note new poses of added frames: frame → (4, 4) T_parent_child."""
        self._swept.update(frames)

    def forget_sweep(self, frame: str) -> None:
        """Drop a noted pose, because the frame is set anew or taken away."""
        self._swept.pop(plain_name(frame), None)

    def settle(self) -> dict[str, Matrix]:
        """Set all noted changes in the tree.

        Returns:
            Child frame → (4, 4) T_parent_child of what changed since the last time.
        """
        moved, self._moved = self._moved, {}
        swept, self._swept = self._swept, {}
        frames = {**self._joint_frames(moved), **swept}
        if frames:
            self._tree.update(frames)
        for frame, T in swept.items():
            self._added.moved(frame, Transform.trusted(T))
        return frames

    def _joint_frames(self, moved: Iterable[str]) -> dict[str, Matrix]:
        robot, kinematics, joints = self.robot, self._kinematics, self.joints
        if robot is None or kinematics is None or joints is None:
            return {}
        positions = joints.all_positions()
        frames: dict[str, Matrix] = {}
        for name in moved:
            frame = plain_name(robot.joints[name].child)
            # A frame that was hung elsewhere by hand no longer follows its joint.
            if frame not in self._added:
                frames[frame] = kinematics.joint_transform(name, positions[name])
        return frames

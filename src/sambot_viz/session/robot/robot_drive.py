"""Drives a robot with two wheels in the frame odom.

It is the odometry of a differential drive without a simulator: the velocities turn the
wheels and move odom → root along exact arcs (see `drive.differential`). The trail is a
line on the floor of odom.
"""

from __future__ import annotations

import math

from sambot_viz.displays.scene.lines import PathLine
from sambot_viz.drive.differential import DifferentialDrive, PlanarPose, WheelPair
from sambot_viz.drive.driven_wheels import find_wheel_pair
from sambot_viz.errors import FrameError, JointError, Problem
from sambot_viz.frames import Transform
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.geometry import Matrix
from sambot_viz.joints.animation import wrap_angle
from sambot_viz.options import Options
from sambot_viz.robot.model import Robot
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.robot.session_frames import Frames
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.signals import Change, Listening, Signal, connect
from sambot_viz.session.worker import Throttle, Worker

ODOM = "odom"
"""The frame that the robot moves in; its origin is on the floor below the start."""
KEEP = 1.5
"""A driven robot stops this long after the last message of the pages that drive it [s];
such a page sends four per second."""
TRAIL_PERIOD = 0.2
"""The trail is drawn at most this often [s]."""


class Drive:
    """Velocities, pose and way of a session's robot.

    Args:
        robot: its wheels turn.
        frames: it is attached to odom.
        options: name the wheels.

    Attributes:
        velocity: linear [m/s], forwards positive, and angular [rad/s], to the left
            positive.
        left_alone: whether the robot was stopped because its time was up.
        pose_changed: the pose in odom, told after it was drawn.
        root: the root link, which moves in odom; empty without wheels.
        why_not: why the robot cannot be driven, or "".
    """

    def __init__(
        self, robot: RobotState, frames: Frames, options: Options, change: Change
    ) -> None:
        self.velocity = Signal(change, (0.0, 0.0))
        self.left_alone = Signal(change, False)
        self.pose_changed = Signal(change, None)
        self.root = ""
        self.why_not = "no robot is shown yet"
        self._robot = robot
        self._frames = frames
        self._options = options
        self._change = change
        self._left = 0.0
        self._drive: DifferentialDrive | None = None
        self._height = 0.0
        self._drawing = Listening(self._tell_pose)

    @property
    def v(self) -> float:
        """The linear velocity [m/s]."""
        return self.velocity.value[0]

    @property
    def w(self) -> float:
        """The angular velocity [rad/s]."""
        return self.velocity.value[1]

    @property
    def wheels(self) -> WheelPair | None:
        """The wheels, or None for a robot that cannot be driven."""
        return self._drive.wheels if self._drive else None

    @property
    def pose(self) -> PlanarPose:
        """The pose of the root link, T_odom_root."""
        return self._drive.pose if self._drive else PlanarPose()

    @property
    def trail(self) -> tuple[tuple[float, float], ...]:
        """Where the point between the wheels was, x, y [m] in odom."""
        return self._drive.trail if self._drive else ()

    @property
    def moving(self) -> bool:
        """Whether the robot drives at the moment."""
        return self._drive is not None and self.velocity.value != (0, 0)

    @property
    def problems(self) -> tuple[Problem, ...]:
        """Why the robot cannot be driven with the wheels that the options name."""
        if not self.why_not or not self._options.names_wheels:
            return ()
        return (Problem("warning", "drive-wheels", self.why_not),)

    def take(self, robot: Robot) -> None:
        """Find the wheels of a robot, new or edited; its place in odom stays."""
        try:
            wheels = self._find(robot)
        except JointError as error:
            self._drive, self.why_not = None, str(error)
            self.velocity.set((0.0, 0.0))
            return
        self.why_not = ""
        centre = robot.forward_kinematics()[robot.joints[wheels.left].child]
        self._height = wheels.radius - float(centre[2, 3])
        root = plain_name(robot.root)
        if self._drive is None or self.root != root or self._drive.wheels != wheels:
            self._drive, self.root = DifferentialDrive(wheels), root

    def set_velocity(self, v: float, w: float, seconds: float = math.inf) -> None:
        """Drive at a velocity, until the next call or the time is up.

        Args:
            v: linear velocity [m/s], forwards positive.
            w: angular velocity [rad/s], to the left positive.
            seconds: how long [s].

        Raises:
            JointError: no wheels, a number that is not finite, or messages move them.
            FrameError: the root link cannot be attached to odom.
        """
        with self._change.lock:
            if self._drive is None:
                raise JointError(f"the robot cannot be driven: {self.why_not}")
            if not (math.isfinite(v) and math.isfinite(w)):
                raise JointError(f"cannot drive with v={v!r}, w={w!r}")
            if v or w:
                self._robot.require_free()
                self.enter_odom()
            self._left = seconds
            self.left_alone.set(False)
            self.velocity.set((v, w))

    def go_on(self, seconds: float) -> None:
        """Drive on for at least this time [s], if the robot drives."""
        self._left = max(self._left, seconds)

    def stop(self) -> None:
        """Stop driving."""
        self.left_alone.set(False)
        self.velocity.set((0.0, 0.0))

    def carries(self, frame: str | None) -> bool:
        """Return whether a frame moves with the robot."""
        while frame is not None and frame != self.root:
            frame = self._frames.tree.parent(frame)
        return frame is not None

    def reset(self) -> None:
        """Stop, put robot and wheels back to the start and forget the trail."""
        with self._change.lock:
            self.stop()
            joints = self._robot.joints
            if self._drive is not None and joints is not None:
                self._drive.reset()
                self._drawing.to(self._robot.positions)
                wheels = self._drive.wheels.left, self._drive.wheels.right
                free = not self._robot.followed.value
                start = {name: joints.start(name) for name in wheels if free}
                placed = self.root in self._frames.added
                self._robot.move(start, {self.root: self._matrix()} if placed else {})

    def draw(self) -> None:
        """Draw the robot where it is now, and not with the next picture."""
        self._robot.draw_moved()

    def advance(self, dt: float) -> tuple[dict[str, float], dict[str, Matrix]]:
        """Drive on for a time [s].

        Returns:
            The new positions of the wheels [rad] and the new T_odom_root, by names.
        """
        state = self._robot.joints
        if self._drive is None or state is None or not self.moving:
            return {}, {}
        if self.root not in self._frames.added:
            # The frame odom was removed.
            self.stop()
            return {}, {}
        self._drawing.to(self._robot.positions)
        step = self._drive.step(self.v, self.w, min(dt, self._left))
        self._left -= dt
        if self._left <= 0:
            self.stop()
            self.left_alone.set(True)
        turned = {
            name: wrap_angle(state.positions[name] + angle)
            for name, angle in step.wheels.items()
        }
        return turned, {self.root: self._matrix()}

    def enter_odom(self) -> None:
        """Attach the root link to odom, unless it is attached there already.

        Raises:
            FrameError: it is attached to another frame.
        """
        parent = self._frames.tree.parent(self.root)
        if parent not in (None, ODOM):
            raise FrameError(
                f"'{self.root}' is attached to '{parent}' already; remove that "
                f"transform to drive in '{ODOM}'"
            )
        if parent is None:
            T = Transform.trusted(self._matrix())
            self._frames.add(ODOM, self.root, T, static=False)

    def leave_odom(self) -> None:
        """Take odom away, if driving has made it and nothing else is in it.

        That is an edit that can be undone.
        """
        tree, added = self._frames.tree, self._frames.added.get(self.root)
        made = added is not None and added.parent == ODOM and not added.static
        alone = tree.parent(ODOM) is None and tuple(tree.children(ODOM)) == (self.root,)
        if made and alone:
            # Its undo finds the robot at the start, where it is now.
            start = Transform.trusted(self._matrix())
            self._frames.add(ODOM, self.root, start, static=False)
            self._frames.remove(self.root)

    def _tell_pose(self) -> None:
        self._drawing.to()
        self.pose_changed.touch()

    def _find(self, robot: Robot) -> WheelPair:
        options = self._options
        if self._robot.has_messages:
            raise JointError("messages move it")
        return find_wheel_pair(
            robot,
            left=options.left_wheel,
            right=options.right_wheel,
            radius=options.wheel_radius,
            separation=options.wheel_separation,
        )

    def _matrix(self) -> Matrix:
        pose = self.pose
        xyz, rpy = (pose.x, pose.y, self._height), (0.0, 0.0, pose.yaw)
        return Transform.from_xyz_rpy(xyz, rpy).matrix


class DriveTrail:
    """Draws a line on the floor of odom.

    Args:
        drive: knows where the robot was.
        robot: another one may have no wheels.
        scene: where to draw.
        change: sends the line.
    """

    def __init__(
        self,
        drive: Drive,
        robot: RobotState,
        scene: Scene,
        change: Change,
        worker: Worker,
    ) -> None:
        self._drive = drive
        self._context = scene.context
        self._change = change
        self._line = PathLine(scene.context.scene)
        self._drawing = Throttle(worker, TRAIL_PERIOD, self._draw)
        self._others = (scene.frames, robot.changed)
        self._driven = Listening(self._drawing.request)
        connect([drive.pose_changed], self._moved)

    def close(self) -> None:
        """Stop drawing for good."""
        self._drawing.close()

    def _moved(self) -> None:
        # A robot that never drove has no trail: until then nothing else matters.
        self._driven.to(*self._others)
        self._drawing.request()

    def _draw(self) -> None:
        with self._change():
            above = self._context.nodes.path(ODOM)
            self._line.draw(above, self._drive.trail or ((0.0, 0.0),))

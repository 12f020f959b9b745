"""A robot with two driven wheels, moved in the frame odom.

It is the odometry of a differential drive without a simulator: the velocities turn the
wheels and move odom → root along exact arcs (see `drive.differential`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from sambot_viz.displays.scene.ribbons import PathLine
from sambot_viz.drive.differential import DifferentialDrive, PlanarPose, WheelPair
from sambot_viz.drive.wheels import find_wheel_pair
from sambot_viz.errors import FrameError, JointError, Problem
from sambot_viz.frames import Transform
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.geometry import Matrix
from sambot_viz.joints.animation import wrap_angle
from sambot_viz.robot.model import Robot
from sambot_viz.session.browser.driver_view import DriverView
from sambot_viz.session.signals import connect
from sambot_viz.session.throttle import Throttle
from sambot_viz.views.camera import Vector

if TYPE_CHECKING:
    from sambot_viz.session import Session

ODOM = "odom"
"""The frame that the robot moves in; its origin is on the floor below the start."""
TRAIL_PERIOD = 0.2
"""The trail is drawn at most this often [s]."""


class DriveControl:
    """Velocities, pose and trail of one session's robot.

    Args:
        session: whose robot it is.
        start: starts the steps (see `Motion.start`).

    Attributes:
        v: linear velocity [m/s], forwards positive.
        w: angular velocity [rad/s], to the left positive.
        why_not: why the robot cannot be driven, or "".
    """

    def __init__(self, session: Session, start: Callable[[], None]) -> None:
        self._session = session
        self._start = start
        self.v = 0.0
        self.w = 0.0
        self._left = 0.0
        self._drive: DifferentialDrive | None = None
        self._root = ""
        self._height = 0.0
        self.why_not = "no robot is shown yet"
        self._line = PathLine(session.audience.scene)
        self._seen = DriverView(session)
        self._drawing = Throttle(session.worker, TRAIL_PERIOD, self._draw_trail)
        signals = session.signals
        connect([signals.joints, signals.frames, signals.robot], self._drawing.request)

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
        return self._drive is not None and (self.v != 0 or self.w != 0)

    @property
    def problems(self) -> tuple[Problem, ...]:
        """Why the robot cannot be driven with the wheels that the options name."""
        options = self._session.options
        named = (
            options.left_wheel,
            options.right_wheel,
            options.wheel_radius,
            options.wheel_separation,
        )
        if not self.why_not or named == (None, None, None, None):
            return ()
        return (Problem("warning", "drive-wheels", self.why_not),)

    def take(self, robot: Robot) -> None:
        """Find the wheels of a robot, new or edited; its place in odom stays."""
        try:
            wheels = self._find(robot)
        except JointError as error:
            self._drive, self.why_not = None, str(error)
            self.v = self.w = 0.0
            return
        self.why_not = ""
        centre = robot.forward_kinematics()[robot.joints[wheels.left].child]
        self._height = wheels.radius - float(centre[2, 3])
        root = plain_name(robot.root)
        if self._drive is None or self._root != root or self._drive.wheels != wheels:
            self._drive, self._root = DifferentialDrive(wheels), root

    def set_velocity(self, v: float, w: float, seconds: float = math.inf) -> None:
        """Drive at a velocity, until the next call or the time is up.

        Args:
            v: linear velocity [m/s], forwards positive.
            w: angular velocity [rad/s], to the left positive.
            seconds: how long [s].

        Raises:
            JointError: no wheels, or a number that is not finite.
            FrameError: the root link cannot be attached to odom.
        """
        with self._session.lock:
            if self._drive is None:
                raise JointError(f"the robot cannot be driven: {self.why_not}")
            if not (math.isfinite(v) and math.isfinite(w)):
                raise JointError(f"cannot drive with v={v!r}, w={w!r}")
            if v or w:
                self.enter_odom()
            self._set(v, w)
            self._left = seconds
        self._start()

    def stop(self) -> None:
        """Stop driving."""
        with self._session.lock:
            self._set(0.0, 0.0)

    def _set(self, v: float, w: float) -> None:
        changed, self.v, self.w = (v, w) != (self.v, self.w), v, w
        if changed:
            self._session.signals.motion.touch()

    def show_motion(self) -> bool:
        """Make the fixed frame one that the robot moves in, if it is one of its own.

        That is an edit that can be undone. The robot stays in the picture of the
        browser that drives.

        Returns:
            Whether the fixed frame was another one.

        Raises:
            FrameError: the root link cannot be attached to odom.
        """
        session = self._session
        with session.lock:
            if self._drive is None:
                return False
            self.enter_odom()
            self._seen.begin()
            fixed = session.context.fixed_frame
            if fixed not in session.tree.frames or not self._carries(fixed):
                return False
            session.set_global("Fixed Frame", ODOM)
            self._seen.make_room()
            return True

    def _carries(self, frame: str | None) -> bool:
        """Whether a frame moves with the robot."""
        while frame is not None and frame != self._root:
            frame = self._session.tree.parent(frame)
        return frame is not None

    def reset(self) -> None:
        """Stop, put robot and wheels back to the start and forget the trail."""
        session = self._session
        with session.lock:
            self.stop()
            if self._drive is not None and session.joints is not None:
                self._drive.reset()
                wheels = self._drive.wheels.left, self._drive.wheels.right
                start = {name: session.joints.start(name) for name in wheels}
                placed = self._root in session.added
                session.move(start, {self._root: self._matrix()} if placed else {})
        self._drawing.request()

    def close(self) -> None:
        """Draw no trail any more."""
        self._drawing.close()

    def advance(self, dt: float) -> tuple[dict[str, float], dict[str, Matrix]]:
        """Drive on for a time [s].

        Returns:
            The new positions of the wheels [rad] and the new T_odom_root, by names.
        """
        state = self._session.joints
        if self._drive is None or state is None or not self.moving:
            return {}, {}
        if self._root not in self._session.added:
            # The frame odom was removed.
            self.stop()
            return {}, {}
        step = self._drive.step(self.v, self.w, min(dt, self._left))
        self._left -= dt
        if self._left <= 0:
            self.stop()
        turned = {
            name: wrap_angle(state.positions[name] + angle)
            for name, angle in step.wheels.items()
        }
        return turned, {self._root: self._matrix()}

    def enter_odom(self) -> None:
        """Attach the root link to odom, unless it is attached there already.

        Raises:
            FrameError: it is attached to another frame.
        """
        session = self._session
        parent = session.tree.parent(self._root)
        if parent not in (None, ODOM):
            raise FrameError(
                f"'{self._root}' is attached to '{parent}' already; remove that "
                f"transform to drive in '{ODOM}'"
            )
        if parent is None:
            T = Transform.trusted(self._matrix())
            session.add_frame(ODOM, self._root, T, static=False)

    def _draw_trail(self) -> None:
        session = self._session
        with session.lock:
            with session.audience.atomic():
                above = session.context.nodes.path(ODOM)
                drawn = self._line.draw(above, self.trail or ((0.0, 0.0),))
            if drawn:
                session.audience.flush()
            self._seen.follow(self._place())

    def _place(self) -> Vector | None:
        """The root link in the fixed frame [m]."""
        tree, fixed = self._session.tree, self._session.context.fixed_frame
        if not self._root or not tree.can_lookup(fixed, self._root):
            return None
        return tree.lookup(fixed, self._root).matrix[:3, 3]

    def _find(self, robot: Robot) -> WheelPair:
        options = self._session.options
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

"""Driving a robot with two wheels: exact arcs, without a simulator.

Two wheels on one axis, each at its own constant speed, move a robot on a circle (or
a line). The pose after such a step is computed from that circle, not from many small
lines, so a step may be as long as one likes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from sambot_viz.errors import JointError


@dataclass(frozen=True, slots=True)
class PlanarPose:
    """A pose on the floor: x, y [m], yaw [rad], the yaw not wrapped.

    ``T_a_b @ T_b_c`` is T_a_c.
    """

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0

    def __matmul__(self, other: PlanarPose) -> PlanarPose:
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return PlanarPose(
            self.x + c * other.x - s * other.y,
            self.y + s * other.x + c * other.y,
            self.yaw + other.yaw,
        )

    def inverse(self) -> PlanarPose:
        """Return the pose of the parent in the child."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return PlanarPose(
            -(c * self.x + s * self.y), s * self.x - c * self.y, -self.yaw
        )


def arc(way: float, turned: float) -> PlanarPose:
    """Compute the exact motion along an arc, in the directions at its beginning.

    Args:
        way: the length of the arc [m], forwards positive.
        turned: the angle of the arc [rad], to the left positive.
    """
    half = _sinc(turned / 2)
    return PlanarPose(way * _sinc(turned), way * turned / 2 * half * half, turned)


def _sinc(angle: float) -> float:
    # Below 1e-8 the next term of the series is smaller than the digits of a float.
    return math.sin(angle) / angle if abs(angle) > 1e-8 else 1.0


@dataclass(frozen=True, slots=True)
class WheelPair:
    """The measures of a differential drive.

    Attributes:
        left: name of the left wheel's joint.
        right: name of the right wheel's joint.
        radius: radius of the wheels [m].
        separation: distance of the wheels along their axis [m].
        left_sign: 1.0 when a growing position drives forwards, else -1.0.
        right_sign: the same for the right wheel.
        middle: the point between the wheels, facing forwards, in the root link.

    Raises:
        JointError: a measure that is not a number above 0, or one wheel named twice.
    """

    left: str
    right: str
    radius: float
    separation: float
    left_sign: float = 1.0
    right_sign: float = 1.0
    middle: PlanarPose = PlanarPose()

    def __post_init__(self) -> None:
        for name, value in (("radius", self.radius), ("separation", self.separation)):
            if not (math.isfinite(value) and value > 0):
                raise JointError(
                    f"the {name} of the wheels is {value!r} m: no number above 0"
                )
        if self.left == self.right:
            raise JointError(f"'{self.left}' cannot be both the left and right wheel")


@dataclass(frozen=True, slots=True)
class DriveStep:
    """The outcome of one step.

    Attributes:
        pose: the new pose of the root link, T_odom_root.
        wheels: wheel joint → how far its position grew [rad].
    """

    pose: PlanarPose
    wheels: dict[str, float]


@dataclass
class DifferentialDrive:
    """A robot on two wheels, driven by a linear and an angular velocity.

    It turns about the point between its wheels. The frame odom is where the root link
    was at the start.

    Attributes:
        wheels: joints and measures.
        trail_step: a new point of the trail is taken after this way [m].
        trail_length: the oldest points beyond this number are forgotten.
    """

    wheels: WheelPair
    trail_step: float = 0.02
    trail_length: int = 5000
    _moved: PlanarPose = field(init=False, default=PlanarPose())
    _trail: list[tuple[float, float]] = field(
        init=False, default_factory=list[tuple[float, float]]
    )

    def __post_init__(self) -> None:
        self.reset()

    @property
    def pose(self) -> PlanarPose:
        """The pose of the root link, T_odom_root."""
        return self._middle @ self.wheels.middle.inverse()

    @property
    def trail(self) -> tuple[tuple[float, float], ...]:
        """The way of the point between the wheels, x, y [m] in odom, oldest first."""
        return tuple(self._trail)

    def wheel_speeds(self, v: float, w: float) -> tuple[float, float]:
        """Speeds of the left and the right wheel [rad/s], forwards positive.

        Args:
            v: linear velocity [m/s], forwards positive.
            w: angular velocity [rad/s], to the left positive.
        """
        half = w * self.wheels.separation / 2
        return (v - half) / self.wheels.radius, (v + half) / self.wheels.radius

    def step(self, v: float, w: float, dt: float) -> DriveStep:
        """Drive for a time at constant velocities, along the exact arc.

        Args:
            v: linear velocity [m/s], forwards positive.
            w: angular velocity [rad/s], to the left positive.
            dt: the time [s].

        Raises:
            JointError: a number that is not finite; nothing moves then.
        """
        if not all(map(math.isfinite, (v, w, dt, v * dt, w * dt))):
            raise JointError(f"cannot drive with v={v!r}, w={w!r} for {dt!r} s")
        self._moved = self._moved @ arc(v * dt, w * dt)
        self._mark()
        left, right = self.wheel_speeds(v, w)
        wheels = self.wheels
        turned = {
            wheels.left: wheels.left_sign * left * dt,
            wheels.right: wheels.right_sign * right * dt,
        }
        return DriveStep(self.pose, turned)

    def reset(self) -> None:
        """Go back to the start and forget the trail."""
        self._moved = PlanarPose()
        self._trail = [(self._middle.x, self._middle.y)]

    @property
    def _middle(self) -> PlanarPose:
        return self.wheels.middle @ self._moved

    def _mark(self) -> None:
        here, (x, y) = self._middle, self._trail[-1]
        if math.hypot(here.x - x, here.y - y) >= self.trail_step:
            self._trail.append((here.x, here.y))
            if len(self._trail) > self.trail_length:
                # Many at once: what is drawn of the others is drawn again after it.
                del self._trail[: max(1, self.trail_length // 5)]

"""Finding the two driven wheels of a robot, and their measures, in its model."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import combinations

import numpy as np
import numpy.typing as npt

from sambot_viz import limits
from sambot_viz.drive.differential import PlanarPose, WheelPair
from sambot_viz.errors import JointError, did_you_mean
from sambot_viz.geometry import Matrix
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Cylinder, Joint, Shape, Sphere

_Vector = npt.NDArray[np.float64]

_PARALLEL = 1e-3
"""Two directions count as one below this sine: URDFs write 1.5708 for a right angle."""


_SAME_LINE = 1e-3
"""Two axes count as one line below this distance [m]."""

_SAME_RADIUS = 0.01
"""Two radii count as equal below this relative difference."""


@dataclass(frozen=True)
class _Wheel:
    """A continuous joint in the root link: a point and the direction of its axis."""

    joint: Joint
    point: _Vector
    axis: _Vector
    radius: float | None


def find_wheel_pair(
    robot: Robot,
    *,
    left: str | None = None,
    right: str | None = None,
    radius: float | None = None,
    separation: float | None = None,
) -> WheelPair:
    """Find the two continuous joints about one level axis, and their measures.

    Given values are used; the others come from the model, with all joints at their
    start values. Of several pairs the one with the largest wheels is chosen.

    Args:
        robot: the robot; z of its root link points up.
        left: name of the left wheel's joint, or None; needs `right`.
        right: name of the right wheel's joint, or None; needs `left`.
        radius: radius of the wheels [m]; None takes it from their cylinders or spheres.
        separation: distance of the wheels [m]; None takes it from the model.

    Raises:
        JointError: no such pair, and why, or an unknown joint.
    """
    poses = robot.forward_kinematics()
    wheels = [
        _wheel(robot, joint, poses[joint.child])
        for joint in robot.joints.values()
        if joint.endless and joint.mimic is None
    ]
    if left is not None or right is not None:
        pair = (_named(left, "left", wheels), _named(right, "right", wheels))
    else:
        pair = _best_pair(wheels)
    return _measured(*pair, radius=radius, separation=separation, ordered=bool(left))


def _named(name: str | None, side: str, wheels: list[_Wheel]) -> _Wheel:
    if name is None:
        raise JointError(f"the {side} wheel's joint is not named, the other one is")
    for wheel in wheels:
        if wheel.joint.name == name:
            return wheel
    names = [wheel.joint.name for wheel in wheels]
    raise JointError(f"no continuous joint '{name}'; {did_you_mean(name, names)}")


def _wheel(robot: Robot, joint: Joint, T_root_link: Matrix) -> _Wheel:
    axis = np.dot(T_root_link[:3, :3], joint.axis)
    link = robot.links[joint.child]
    for shape in (*link.collisions, *link.visuals):
        radius = _rolling_radius(shape, joint)
        if radius is not None:
            middle = np.dot(T_root_link, (*shape.origin.xyz, 1.0))[:3]
            # Only along the axis may the middle of the tyre be beside the joint.
            offset = np.dot(middle - T_root_link[:3, 3], axis)
            return _Wheel(joint, T_root_link[:3, 3] + offset * axis, axis, radius)
    return _Wheel(joint, T_root_link[:3, 3], axis, None)


def _rolling_radius(shape: Shape, joint: Joint) -> float | None:
    """The radius of a sphere, or of a cylinder that lies along the joint's axis."""
    if isinstance(shape.geometry, Sphere):
        return shape.geometry.radius
    if not isinstance(shape.geometry, Cylinder):
        return None
    along = shape.origin.matrix[:3, 2]
    return shape.geometry.radius if _parallel(along, np.array(joint.axis)) else None


def _parallel(one: _Vector, other: _Vector) -> bool:
    sine = np.linalg.norm(np.cross(one, other))
    return bool(sine < _PARALLEL) and bool(np.any(one)) and bool(np.any(other))


def _best_pair(wheels: list[_Wheel]) -> tuple[_Wheel, _Wheel]:
    if len(wheels) < 2:
        raise JointError(
            f"a differential drive needs two continuous joints; this robot has "
            f"{len(wheels)}"
        )
    level = [wheel for wheel in wheels if abs(wheel.axis[2]) <= _PARALLEL]
    if len(level) > limits.WHEELS.value:
        raise JointError(
            f"{len(level)} continuous joints turn about level axes, more than the "
            f"{limits.WHEELS.value} among which the driven wheels are guessed; name "
            "the left and the right one"
        )
    pairs = [pair for pair in combinations(level, 2) if _is_pair(*pair)]
    if not pairs:
        names = ", ".join(f"'{wheel.joint.name}'" for wheel in wheels)
        raise JointError(
            "no two of the continuous joints turn about one level axis with wheels "
            f"of one size: {names}; name the left and the right wheel"
        )
    return max(pairs, key=lambda pair: pair[0].radius or 0.0)


def _is_pair(one: _Wheel, other: _Wheel) -> bool:
    between = other.point - one.point
    distance = float(np.linalg.norm(between))
    beside = float(np.linalg.norm(np.cross(between, one.axis)))
    if distance < _SAME_LINE or beside > _SAME_LINE:
        return False
    if not _parallel(one.axis, other.axis):
        return False
    if one.radius is None or other.radius is None:
        return one.radius is other.radius
    return math.isclose(one.radius, other.radius, rel_tol=_SAME_RADIUS)


def _measured(
    one: _Wheel,
    other: _Wheel,
    *,
    radius: float | None,
    separation: float | None,
    ordered: bool,
) -> WheelPair:
    radius = radius if radius is not None else (one.radius or other.radius)
    if radius is None:
        raise JointError(
            f"the wheels '{one.joint.name}' and '{other.joint.name}' have no cylinder "
            "or sphere to take their radius from; give the radius"
        )
    if ordered:
        left, right = one, other
    else:
        left, right = _sides(one, other)
    across = left.point - right.point
    width = float(np.hypot(across[0], across[1]))
    # Forwards is to the right of the direction from the right wheel to the left one.
    forward = np.array((across[1], -across[0], 0.0)) / (width or 1.0)
    middle = (left.point + right.point) / 2
    return WheelPair(
        left.joint.name,
        right.joint.name,
        radius,
        separation if separation is not None else width,
        _sign(left, forward),
        _sign(right, forward),
        PlanarPose(*middle[:2].tolist(), yaw=math.atan2(forward[1], forward[0])),
    )


def _sides(one: _Wheel, other: _Wheel) -> tuple[_Wheel, _Wheel]:
    """Left and right for a robot that looks along x, or along y if it cannot."""
    across = one.point - other.point
    forward_x, forward_y = across[1], -across[0]
    looks_back = forward_x < -_SAME_LINE or (
        abs(forward_x) <= _SAME_LINE and forward_y < 0
    )
    return (other, one) if looks_back else (one, other)


def _sign(wheel: _Wheel, forward: _Vector) -> float:
    """A wheel that turns about `axis` rolls along axis × up."""
    rolls = np.array((wheel.axis[1], -wheel.axis[0], 0.0))
    return 1.0 if float(np.dot(rolls, forward)) >= 0 else -1.0

"""Compare wheel sizes of differential drives with the model."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from sambot_viz.checks.around.files.gazebo import Fact, plugins
from sambot_viz.checks.around.place import where
from sambot_viz.checks.rule import listed, number
from sambot_viz.edits import copy_as, write
from sambot_viz.errors import Fix, Problem
from sambot_viz.geometry import UP, dot
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Box, Cylinder, Joint, Sphere

if TYPE_CHECKING:
    from sambot_viz.checks.around.surroundings import Surroundings

_SEPARATION_OFF = 0.15
_SEPARATION_OFF_MESH = 0.25
_OF_BODY = 0.05
_RADIUS_OFF = 0.1
_SKIDDING = 4
_SAME_PLACE = 0.001
"""Distance below which wheels have no separation [m]."""


class _Drive(NamedTuple):
    """The wheels of a drive, by its settings.

    Attributes:
        left: the joints on the left.
        right: those on the right, in the same order.
        separations: the distance of each pair [m].
        radius: the radius of the wheels [m], or None.
        diameter: their diameter [m], or None.
    """

    left: Sequence[str]
    right: Sequence[str]
    separations: Sequence[Fact]
    radius: Fact | None
    diameter: Fact | None = None


def wheel_sizes(robot: Robot) -> Iterator[Problem]:
    """Report a wheel separation or radius of a plugin that differs from the model's."""
    for plugin in plugins(robot.gazebo):
        if plugin.is_drive:
            drive = _Drive(
                [fact.value for fact in plugin.all("left_joint", "leftJoint")],
                [fact.value for fact in plugin.all("right_joint", "rightJoint")],
                plugin.all("wheel_separation", "wheelSeparation"),
                plugin.one("wheel_radius"),
                plugin.one("wheel_diameter", "wheelDiameter"),
            )
            yield from _compare(robot, drive)


def wheel_sizes_of_controllers(around: Surroundings) -> Iterator[Problem]:
    """Report sizes in a diff_drive_controller that differ from the model's."""
    for file in around.yaml_files if around.robot.gazebo else ():
        for node in file.nodes:
            given = file.of(node)
            left, right = given.get("left_wheel_names"), given.get("right_wheel_names")
            apart, radius = given.get("wheel_separation"), given.get("wheel_radius")
            if left is not None and right is not None:
                drive = _Drive(
                    left.values,
                    right.values,
                    [apart.fact] if apart else [],
                    radius.fact if radius else None,
                )
                yield from _compare(around.robot, drive)


def _compare(robot: Robot, drive: _Drive) -> Iterator[Problem]:
    pairs = list(_pairs(robot, drive))
    if pairs:
        yield from _sinking(robot, [joint for pair in pairs for joint in pair])
        yield from _separation(robot, drive, pairs)
        yield from _radius(robot, drive, pairs[0][0])


def _sinking(robot: Robot, joints: Sequence[Joint]) -> Iterator[Problem]:
    """Report driven wheels without a collision under a body that has one."""
    links = [robot.links[joint.child] for joint in joints]
    sinking = [link for link in links if link.inertial and link.visuals]
    parts = [robot.links[joint.parent] for joint in joints]
    fixed = [j for j in robot.joints.values() if j.type == "fixed"]
    # A tyre may be a link of its own.
    holders = {j.parent for j in fixed if robot.links[j.child].collisions}
    sinking = [x for x in sinking if not x.collisions and x.name not in holders]
    if not sinking or not any(part.collisions for part in parts):
        return
    one, wheel = len(sinking) == 1, sinking[0]
    visual, place = wheel.visuals[0], wheel.place
    is_round = isinstance(visual.geometry, (Cylinder, Sphere))
    edits = copy_as(visual.place, "visual", "collision", ("origin", "geometry"))
    yield Problem.at(
        place,
        "warning",
        "wheel-not-on-ground",
        f"the driven wheel{'' if one else 's'} {listed(x.name for x in sinking)} "
        f"{'has' if one else 'have'} no <collision>, and the body has one: in Gazebo "
        f"{'it sinks' if one else 'they sink'} into the ground, and the robot does not "
        "drive",
        Fix(
            "add a <collision> with the shape of the <visual>",
            edits if is_round and robot.language == "urdf" else (),
        ),
    )


def _pairs(robot: Robot, drive: _Drive) -> Iterator[tuple[Joint, Joint]]:
    for left, right in zip(drive.left, drive.right, strict=False):
        one, other = robot.joints.get(left), robot.joints.get(right)
        if one is not None and other is not None and one.movable and other.movable:
            yield one, other


def _separation(
    robot: Robot, drive: _Drive, pairs: list[tuple[Joint, Joint]]
) -> Iterator[Problem]:
    for fact, (left, right) in zip(drive.separations, pairs, strict=False):
        apart = _apart(robot, left, right)
        wheel = _wheel(robot, left)
        if apart is None or fact.number is None:
            continue
        width = wheel.length if isinstance(wheel, Cylinder) else 0.0
        share = _SEPARATION_OFF if wheel else _SEPARATION_OFF_MESH
        off = abs(fact.number - apart)
        body = _body_width(robot, left)
        of_body = off > _OF_BODY * apart and abs(body - fact.number) < 1e-6
        if off <= max(1.01 * width, share * apart) and not of_body:
            continue
        wheels = sum(joint.endless for joint in robot.joints.values())
        if fact.number > apart and (len(pairs) > 1 or wheels >= _SKIDDING):
            # Skidding wheels behave like wheels farther apart.
            continue
        if apart < body <= fact.number:
            yield _inside(robot, left, right, apart, fact)
            continue
        yield Problem.at(
            fact.place,
            "warning",
            "drive-wheel-separation",
            f"the wheel separation is {number(fact.number)} m here, but the wheels of "
            f"{left.name} and {right.name} ({where(left.place, fact.place)}) are "
            f"{number(apart)} m apart: odometry turns by wrong angles",
            write(fact.place, fact.value, number(apart)),
        )


def _body_width(robot: Robot, wheel: Joint) -> float:
    """Return the width of the only box of the body; 0 for other bodies [m]."""
    link = robot.links[wheel.parent]
    shapes = link.collisions or link.visuals
    box = shapes[0].geometry if len(shapes) == 1 else None
    return box.size[1] if isinstance(box, Box) else 0.0


def _inside(
    robot: Robot, left: Joint, right: Joint, apart: float, said: Fact
) -> Problem:
    """Report wheels inside the body that the drive has beside it."""
    place = left.origin.place or left.place
    return Problem.at(
        place,
        "warning",
        "drive-wheel-separation",
        f"the wheels of {left.name} and {right.name} are {number(apart)} m apart, "
        f"inside of the body, which is {number(_body_width(robot, left))} m wide, but "
        f"the wheel separation ({where(said.place, place)}) is {said.value} m",
        f"write {number((said.number or 0.0) / 2)} and its negative for y in their "
        "<origin>",
    )


def _apart(robot: Robot, left: Joint, right: Joint) -> float | None:
    """Return the distance of two wheels along a common axis [m]; None without one."""
    T_left, T_right = robot.at_start[left.child], robot.at_start[right.child]
    axis, other = T_left.turned(left.axis), T_right.turned(right.axis)
    if abs(dot(axis, other)) < 0.99:
        return None
    apart = abs(dot(T_left.position, axis) - dot(T_right.position, axis))
    return apart if apart > _SAME_PLACE else None


def _radius(robot: Robot, drive: _Drive, pair: Joint) -> Iterator[Problem]:
    wheel = _wheel(robot, pair)
    fact, times, what = (
        (drive.radius, 1, "radius") if drive.radius else (drive.diameter, 2, "diameter")
    )
    if wheel is None or fact is None or fact.number is None:
        return
    if abs(fact.number - times * wheel.radius) <= _RADIUS_OFF * times * wheel.radius:
        return
    yield Problem.at(
        fact.place,
        "warning",
        "drive-wheel-radius",
        f"the wheel {what} is {number(fact.number)} m here, but the wheel of "
        f"{pair.name} has the {what} {number(times * wheel.radius)} m "
        f"({where(robot.links[pair.child].place, fact.place)}): speed and odometry "
        "are wrong",
        write(fact.place, fact.value, number(times * wheel.radius)),
    )


def _wheel(robot: Robot, joint: Joint) -> Cylinder | Sphere | None:
    """Return the shape of a wheel that turns about its axis; None for other shapes."""
    link = robot.links[joint.child]
    shapes = link.collisions or link.visuals
    if len(shapes) != 1:
        return None
    geometry = shapes[0].geometry
    along = abs(dot(shapes[0].origin.pose.turned(UP), joint.axis)) > 0.99
    if isinstance(geometry, Sphere) or (isinstance(geometry, Cylinder) and along):
        return geometry
    return None

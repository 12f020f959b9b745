"""Angles that are written in degrees (spec/ros-nodes.md §7.5, §8: URDF has radians)."""

from __future__ import annotations

import math
from collections.abc import Iterator

from sambot_viz.checks.rule import Finding, Rule, Subject, number
from sambot_viz.errors import Place
from sambot_viz.geometry import Vector3

_FULL_TURN = 2 * math.pi + 1e-3
_LARGEST_LIMIT = 720.0


def _looks_like_degrees(value: float) -> bool:
    """More than a full turn, and as round as people write degrees."""
    return abs(value) > _FULL_TURN and abs(value * 2 - round(value * 2)) < 1e-9


def _limits(subject: Subject) -> Iterator[Finding]:
    if subject.robot is None:
        return
    for joint in subject.robot.joints.values():
        limit = joint.limit
        if joint.type != "revolute" or limit is None:
            continue
        ends = [v for v in (limit.lower, limit.upper) if v]
        if not ends or max(abs(v) for v in ends) > _LARGEST_LIMIT:
            # Larger numbers stand for "no limit", not for an angle.
            continue
        if not all(_looks_like_degrees(v) and abs(v) >= 10 for v in ends):
            continue
        yield Finding(
            f"joint {joint.name}: the limits {number(limit.lower)} and "
            f"{number(limit.upper)} look like degrees, but URDF uses radians",
            f'write lower="{number(math.radians(limit.lower))}" '
            f'upper="{number(math.radians(limit.upper))}"',
            subject.inside(joint.place, "limit"),
        )


def _rpys(subject: Subject) -> Iterator[Finding]:
    if subject.robot is None:
        return
    for joint in subject.robot.joints.values():
        yield from _rpy(subject, joint.origin.rpy, joint.place)
    for link in subject.robot.links.values():
        for shape in (*link.visuals, *link.collisions):
            yield from _rpy(subject, shape.origin.rpy, shape.place)
        if link.inertial is not None:
            place = subject.inside(link.place, "inertial")
            yield from _rpy(subject, link.inertial.origin.rpy, place)


def _rpy(subject: Subject, rpy: Vector3, place: Place | None) -> Iterator[Finding]:
    turned = [v for v in rpy if v]
    if not any(_looks_like_degrees(v) for v in turned):
        return
    if not all(abs(v * 2 - round(v * 2)) < 1e-9 for v in turned):
        return
    written = " ".join(number(v) for v in rpy)
    mended = " ".join(number(math.radians(v)) for v in rpy)
    yield Finding(
        f'rpy="{written}" looks like degrees, but URDF uses radians',
        f'write rpy="{mended}"',
        subject.inside(place, "origin"),
    )


LIMIT_IN_DEGREES = Rule(
    code="limit-in-degrees",
    severity="warning",
    title="Joint limits in degrees",
    why="URDF angles are radians. A limit of 90 allows fourteen full turns.",
    example="""\
<robot name="r">
  <link name="a"/>
  <link name="b"/>
  <joint name="j" type="revolute">
    <parent link="a"/>
    <child link="b"/>
    <limit lower="-90" upper="90" effort="1" velocity="1"/>
  </joint>
</robot>
""",
    find=_limits,
)

RPY_IN_DEGREES = Rule(
    code="rpy-in-degrees",
    severity="warning",
    title="rpy in degrees",
    why="URDF angles are radians: a quarter turn is 1.5708, not 90.",
    example="""\
<robot name="r">
  <link name="a">
    <visual>
      <origin xyz="0 0 0" rpy="90 0 0"/>
      <geometry><cylinder radius="0.1" length="0.02"/></geometry>
    </visual>
  </link>
</robot>
""",
    find=_rpys,
)

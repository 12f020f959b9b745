"""Report casters that reach below the floor on which the wheels stand."""

from __future__ import annotations

from collections.abc import Iterator

from sambot_viz.checks.clues import guess
from sambot_viz.checks.model.axles import (
    axle_of,
    wheels_across_their_axles,
    wheels_in_one_place,
)
from sambot_viz.checks.model.ground import wheels_off_the_ground
from sambot_viz.checks.model.slips import sizes_not_positive
from sambot_viz.checks.rule import Subject, listed
from sambot_viz.checks.wheel_clues import lows, wheel_clues
from sambot_viz.edits import negate_part, overwrite_attribute, source_of, write_part
from sambot_viz.errors import Edit, Fix, Problem
from sambot_viz.robot.balance.ground import axle_of as level_axle_of
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Joint
from sambot_viz.robot.slips.wheel_names import CASTER

_SAME = 0.005
"""Difference below which heights are equal [m]."""
_SHARE = 0.25
"""Depth that may be right [height of the axles above the floor]."""
_LEAST = 0.015
"""Depth below which a model is only inexact [m]."""


_CAUSES = (
    sizes_not_positive,
    wheels_across_their_axles,
    wheels_in_one_place,
    wheels_off_the_ground,
)
"""Rules whose findings say why the wheels may be at another height."""


def low_casters(subject: Subject) -> Iterator[Problem]:
    """Report casters below wheels that stand on one floor, each by itself.

    The robot would stand tilted. With base_footprint at the wheels it is certain that
    these are at the right height.
    """
    robot = subject.robot
    found = _floor(robot)
    if found is None:
        return
    floor, height, wheels = found
    carriers = {j.parent for j in robot.joints.values() if j.child in wheels}
    casters = (
        (joint, floor - min(lows(robot, joint.child), default=floor))
        for joint in robot.joints.values()
        if CASTER.search(joint.child) and joint.child not in wheels
    )
    least = max(_LEAST, _SHARE * height)
    deep = [(joint, depth) for joint, depth in casters if depth > least]
    # A right robot runs none of the other rules a second time.
    if not deep or any(cause for rule in _CAUSES for cause in rule(subject)):
        return
    for joint, depth in deep:
        yield guess(
            joint.origin.place or joint.place,
            "wheel-not-on-ground",
            f"{joint.child} ends {depth:.3g} m below the floor on which "
            f"{listed(wheels)} stand: the robot is tilted",
            _relative_to_parent(robot, joint, depth)
            or Fix(
                f"raise the origin of joint {joint.name} by {depth:.3g} m, or "
                "correct the radius",
                _raised(joint, depth) if joint.parent in carriers else (),
            ),
            {"height", "name"},
        )


def _floor(robot: Robot) -> tuple[float, float, list[str]] | None:
    """Return the height of the floor in the root, that of the axles, and the wheels."""
    floors: dict[str, tuple[float, float]] = {}
    for joint in robot.joints.values():
        T = robot.at_start[joint.child]
        is_wheel = axle_of(joint) is not None and level_axle_of(joint, T) is not None
        if not is_wheel or CASTER.search(joint.child):
            continue
        if not wheel_clues(robot, joint):
            continue
        low = min(lows(robot, joint.child), default=None)
        if low is None:
            return None
        floors[joint.child] = (low, T.position[2] - low)
    if len(floors) < 2:
        return None
    heights = [low for low, _ in floors.values()]
    if max(heights) - min(heights) > _SAME:
        return None
    return min(heights), max(above for _, above in floors.values()), list(floors)


def _raised(joint: Joint, depth: float) -> tuple[Edit, ...]:
    """Return the edit of a height that is a number: its sign, or the height itself."""
    z = joint.origin.xyz[2]
    if abs(depth + 2 * z) < _SAME:
        return negate_part(joint.origin.place, "xyz", 2)
    return write_part(joint.origin.place, "xyz", 2, f"{z}", f"{round(z + depth, 4):g}")


def _relative_to_parent(robot: Robot, joint: Joint, depth: float) -> Fix | None:
    """Return the fix of a pose that counts from another frame than the parent."""
    place = joint.origin.place
    source = source_of(place.file) if place is not None else None
    tag = source.tag(source.offset(place)) if source and place else None
    if source is None or tag is None or "relative_to" not in tag.values:
        return None
    base = source.text[slice(*tag.values["relative_to"])]
    if base == joint.parent or base not in robot.at_start:
        return None
    heights = [robot.at_start[link].position[2] for link in (joint.parent, base)]
    if abs(heights[0] - heights[1] - depth) > _SAME:
        return None
    hint = f'write relative_to="{joint.parent}"'
    return Fix(hint, overwrite_attribute(place, "relative_to", joint.parent))
